"""Fuzzing of what reads people's files: accepted or refused by InputError, never a traceback or a hang."""
