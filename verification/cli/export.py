"""`rough-friction verify --export`: the suite's problems with certified pressures, as files."""

from __future__ import annotations

import argparse

from verification.cli.output import emit, refusal, select_or_refuse
from verification.output.text_table import columns


def run(options: argparse.Namespace) -> int:
    """Write the folder and name what is not certified; status 1 where a proof exists for its kind."""
    from verification.framework.threads import limited_to_one_thread
    from verification.output.files import Progress
    from verification.solver_suite import suite
    from verification.solver_suite.reference.certified import NoBound, NotCertified, certified
    from verification.solver_suite.reference.files import Export
    from verification.solver_suite.reference.posed import problems

    progress = Progress(len(select_or_refuse(options.only, lambda: suite.select(options.only))))
    failed = False
    bounds, uncertified, last = [], [], ""
    with limited_to_one_thread(), Export(options.export) as export:
        for named in problems(options.only):
            if named.case != last:
                progress.tick(named.case)
                last = named.case
            try:
                found = certified(named.problem)
            except NotCertified as reason:
                failed = failed or not isinstance(reason, NoBound)
                export.report_uncertified(named.name, str(reason))
                uncertified.append([named.name, str(reason)])
                continue
            export.add(named.name, named.case, found)
            bounds.append(found.bounds.pressure / (float(found.pressure.max()) or 1.0))
        progress.close()
        if not bounds:
            raise refusal("--only", options.only, "cases with a problem of at most 64 elements a side")
        version = export.close()
    document = {
        "folder": str(options.export),
        "version": version,
        "suite": suite.identity(),
        "problems": len(bounds),
        "largest_relative_bound": max(bounds),
        "not_certified": dict(uncertified),
    }
    summary = (
        f"{len(bounds)} problems in {options.export}; pressures are proven to {max(bounds):.2g} of the peak\n"
        f"version {version}"
    )
    table = "\n\n".join(filter(None, [columns(uncertified), summary]))
    emit(document, options.json, table)
    return 1 if failed else 0
