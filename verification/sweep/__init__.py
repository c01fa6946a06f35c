"""Ensembles: many realisations x roughness x load x direction x offset x grid, solved once each and kept."""
