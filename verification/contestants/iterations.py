"""Iterations of constrained conjugate gradients on the problems of the covering designs, to a tenth of 1e-8.

Counted once, at commit 43108c8b, by its `verification.contestants.compact`; in the order of the rows. 2000 is
that solver's limit. Large grids and problems with a hardness are not counted.
"""

from __future__ import annotations

_COUNTED = {
    "plain": """
        22 34 22 3 17 20 18 41 28 24 26 7 46 30 32 35 22 28 38 32 21 36 35 43 37 58 50 28 30 32 77 105 18
        23 42 62 38 31 18 76 7 177 77 132 7 38 29 73
    """,
    "sliding": """
        85 72 55 306 282 176 60 7 67 360 455 45 276 338 145 134 74 92 93 92 730 141 158 120 145 504 519 23
        254 57 715 105 128 136 509 189 434 137 126 42 432 1472 601 191 25 147 1483 255 1095 260 266 177
        200 2000 200 982 394 361 854 299 200 629 295 1074 282 53 2000 752 2000 2000
    """,
    "oblong": """
        32 90 70 51 127 139 41 127 393 206 43 83 322 153 83 55 523 23 266 120 217 410 339 110 350 248 247
        1371 50 487
    """,
    "triples": """
        105 78 148 40 76 141 104 100 51 182 136 33 61 207 143 47 141 142 60 56 253 152 65 54 62 55 259 55
        67 225 55 177 79 81 155 328 50 61 66 160 225 191 238 128 80 111 100 234 251 92 96 214 46 45 76 67
        122 175 70 283 86 232 98 69 57 325 222 299 65 101 71 57 306 84 76 104 93 62 347 334 165 67 96 224
        139 243 334
    """,
    "tiny": """
        2 1 18 2 1 51 3 3 11 3 36
    """,
    "memory": """
        100 104 117 134 161 101 167 122 171 149 210 116 142 161 196 181 216 185 212 160 230 153 213 198
    """,
}
ITERATIONS = {
    f"design-{design}-{number:02}": int(count)
    for design, counts in _COUNTED.items()
    for number, count in enumerate(counts.split(), start=1)
}
"""By slug."""
