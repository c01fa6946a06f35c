"""Cases of validation: predictions beside published measurements."""
