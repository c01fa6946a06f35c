"""Published experiments against predictions: measured data with their sources, scenes, and the comparison.

Searched on 2026-11-26: stored copies of public pages, documentation, issues and repositories. Of most pages
only the first 2000 characters were stored, so tables inside articles could not be read.

- glass lenses on silicone rubber, smooth, randomly rough and with spherical asperities (arXiv 1701.08013,
  1701.08001, 1902.06664; PNAS 115, 471): abstracts: friction stress independent of pressure on smooth
  lenses, sublinear on rough ones; no loads, areas or statistics; used: no
- indentation of rubber and metals with raw data: two repositories with load and depth, tip radius or
  moduli; used: yes: rubber, tungsten
- ball on flat with solid lubricants: abstract with ranges, exponent, tau and beta (doi 10.1063/1.104276);
  used: yes: film
- the same with diamond-like carbon (WTC2005, 42029/829): abstract: 12 and 31 MPa on two counterfaces, no
  coefficients of friction; used: no
- single and rough asperities, atomic force microscope: gold on mica: tau, beta, and the friction stress of
  a rough asperity; used: yes: mica
- the same: graphite, diamond, carbon, C60 (doi 10.1103/PhysRevB.56.6987); diamond on tungsten carbide (doi
  10.1103/PhysRevLett.81.1877): friction goes with the load to the power 2/3, or with the area; no numbers
  with uncertainties; used: no: a law by construction
- contact-mechanics challenge and its printed copy of acrylic (arXiv 1512.02403, doi
  10.1007/s11249-017-0900-2, Bennett and others 2017): abstract: contact from below 0.1 % to over 60 %,
  pressure over modulus from below 0.001 to over 1; neither statistics nor points; used: no
- polystyrene and silicon spheres (doi 10.1038/s41467-018-02981-y): captions: mean contact pressure from 100
  to 250 MPa; topography only in a supplement; used: no
- 1 mm balls of steel and carbide on glass, silica, sapphire: abstract: radii agree with Hertz on soda-lime
  glass, and are significantly larger on the two others; no radii; used: no
- glassy polymers, road surfaces, films of soft metals, hydrogels: laws and qualitative statements; used: no

Two further conversions of the paper (studylib.net/doc/18353327, vdocuments.net) are stored as title and
abstract only: the signs of (A5) and (9) and the digit of Table 2 could not be compared.
"""
