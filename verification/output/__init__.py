"""Result files, whole files, provenance, tables of text, progress: a room below command line and report."""
