"""Reference data: problems of the suite with certified pressures and proven bounds, as files.

`posed` gathers the problems, `certified` solves and bounds them, `files` writes a folder, `schema.json`
describes its index, `agreement` compares a folder, or another code's pressures, with it.
"""
