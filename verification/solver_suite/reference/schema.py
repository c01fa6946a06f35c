"""JSON schema (draft 2020-12) of the index of reference data."""

from __future__ import annotations

from typing import Any

FORMAT = "rough-friction reference data, version 1"


def _number(meaning: str, **limits: float) -> dict[str, Any]:
    return {"type": "number", "description": meaning, **limits}


def _object(properties: dict[str, Any], meaning: str = "") -> dict[str, Any]:
    """A closed object, all of whose properties are required."""
    about = {"description": meaning} if meaning else {}
    closed = {"required": list(properties), "additionalProperties": False}
    return {"type": "object", **about, "properties": properties, **closed}


def _pair(of: str, meaning: str) -> dict[str, Any]:
    items = {"type": of, "exclusiveMinimum": 0}
    return {"type": "array", "description": meaning, "items": items, "minItems": 2, "maxItems": 2}


_TEXT: dict[str, Any] = {"type": "string", "minLength": 1}
_FLAG: dict[str, Any] = {"enum": [0, 1]}
_FILE: dict[str, Any] = {"type": "string", "pattern": r"^data/[a-z0-9-]+\.(gap|pressure)\.f64$"}
_PROBLEM = _object(
    {
        "shape": _pair("integer", "elements along x and y"),
        "lengths": _pair("number", "lengths of the domain along x and y (m)"),
        "reduced_modulus": _number("E* (Pa)", exclusiveMinimum=0),
        "control": {"enum": ["load", "approach"]},
        "value": _number("load (N) or approach (m); periodic: from the mean planes"),
        "periodic": _FLAG,
        "friction": _FLAG,
        "tau": _number("shear strength (Pa)", minimum=0),
        "beta": _number("friction coefficient proper", minimum=0),
        "shear_compliance": _number("c0 (1/Pa), lower body minus upper"),
        "sliding_direction": _number("phi (rad)"),
        "hardness": _number("pressures end here (Pa); 0: they do not", minimum=0),
    },
    "the terms are those of docs/check-your-solver.md",
)
_BOUNDS = _object(
    {
        "pressure": _number("of each element (Pa)", minimum=0),
        "pressure_l2": _number("root of sum (f - f*)^2 dA (Pa m)", minimum=0),
        "energy": _number("sum (f - f*) a (f - f*) dA (J)", minimum=0),
        "approach": _number("m", minimum=0),
        "load": _number("N", minimum=0),
    },
    "proven bounds on |exported - solution|",
)
_RESIDUAL = _object(
    {name: _number("relative", minimum=0) for name in ("gap", "balance", "tension")},
    "recomputed from the pressures by the suite's own operators",
)
_ANSWER = _object(
    {
        "approach": _number("m, as the problem counts it"),
        "load": _number("N", minimum=0),
        "largest_pressure": _number("Pa", minimum=0),
        "elements_in_contact": {"type": "integer", "minimum": 0},
        "elements_undecided": {"type": "integer", "minimum": 0, "description": "codes 2 and 3"},
        "bounds": _BOUNDS,
        "condition": {"type": "string", "description": "what the bounds hold fixed; empty: nothing"},
        "residual": {"oneOf": [_RESIDUAL, {"type": "null"}], "description": "null without elastic energy"},
    }
)
_FILES = _object(
    {
        "gap": _FILE,
        "pressure": _FILE,
        "contact": {"type": "string", "pattern": r"^data/[a-z0-9-]+\.contact\.u8$"},
    }
)
_ENTRY = _object({"name": _TEXT, "case": _TEXT, "problem": _PROBLEM, "answer": _ANSWER, "files": _FILES})
_UNCERTIFIED = _object({"name": _TEXT, "reason": _TEXT})

SCHEMA: dict[str, Any] = {
    "$schema": "https://json-schema.org/draft/2020-12/schema",
    "title": FORMAT,
    **_object(
        {
            "format": {"const": FORMAT},
            "license": {"const": "MIT"},
            "suite": _object({"version": _TEXT, "cases": {"type": "integer"}, "digest": _TEXT}),
            "software": {"type": "object", "additionalProperties": {"type": ["string", "null"]}},
            "tolerance": _number("relative residual required of the solver", exclusiveMinimum=0),
            "contact_codes": {"type": "array", "items": _TEXT, "minItems": 4, "maxItems": 4},
            "problems": {"type": "array", "items": _ENTRY, "minItems": 1},
            "not_certified": {"type": "array", "items": _UNCERTIFIED},
        }
    ),
}
