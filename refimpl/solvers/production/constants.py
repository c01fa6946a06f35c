"""The production solver's constants in one table: what each is, why, and what other values cost.

Costs are CG steps or transforms, on the scenes named; "none" says that neighbouring values change nothing.
"""

# Nested grids (`coarse_grids`, `nested_solver`)
COARSEST = 32  # elements per side of the coarsest grid
COARSEST_OF_TWO = 16  # elements per side where no coarser grid would exist otherwise
QUARTERED = 128  # elements per side up to which a grid of half as many costs more steps than it saves
COARSE_TOLERANCE = 1e-3  # residual of a coarse grid: only an initial guess; its grid error is larger
#                          (1e-2: 4 % fewer transforms on 40 rough scenes, 50 % more on smooth 1024 x 1024)
COARSE_SIDE = 512  # elements per side up to which it holds; beyond, it falls as the next start's error does
#                    (without: 11 % more transforms on smooth 2048 x 2048 with friction, 10 % on rough)
START_MISFIT = 0.02  # largest misfit of a start on the same grid: 1 % of load saves up to a third of the
#                      transforms, 5 % costs up to two thirds more
CAPPED_STEP = 0.25  # share of an element's stiffness in the step that shows who reaches the cap (0.12 and
#                     0.5: 4 % more transforms on 90 capped scenes of 128 to 512 elements a side, 1: 11 %)
MARGIN = 2  # elements, at least, by which a window exceeds its contact: slopes at its edge are one-sided

# One grid (`level`)
REDUCTION = 0.1  # relative residual reduction by CG between updates of the lagged terms
LEAST_REDUCTION = 1e-3  # reduction where the last update changed the residual by less than that
TOLERANCE_SHARE = 0.99  # share of the tolerance: the certificate differs by rounding (1e-15 of 1e-12)
LAGGED_SHARE = 0.3  # share of the tolerance, for CG where terms lag: the rest is for the lagged terms
PLAIN_SHARE = 0.9  # share of the tolerance, for CG where nothing lags: the rest is for rounding
MIXED_SHARE = 0.1  # share of the tolerance, for CG between mixed updates: its residual is noise to the mixing
CG_LIMIT = 1000  # CG steps of one solve; the extreme scenes that converge take 108 at most
CG_PATIENCE = 40  # CG steps without a tenth's progress before the residual counts as stagnant
NEAR_ROUNDING = 1e-12  # residual below which steps or updates without progress are rounding, whose floor is
#                        1e-15 to 3e-14 on Table 1's ball, 32 to 512 elements per side
ROUNDING_PATIENCE = 8  # CG steps without a tenth's progress there: at 1e-16 100 CG steps in place of 1000
UPDATE_LIMIT = 600  # updates of the lagged terms in one solve; the extreme scenes take 59 at most

# Projected CG (`projected_cg`, `contact_vectors`)
FIRST_LENGTH = 0.7  # first step length: the preconditioned spectrum lies between 1 and 2 (tests)
TRIAL_SHARE = 0.8  # trial over last best length: longer trials leave cut elements halfway
TRUSTED = (0.4, 3.0)  # best over trial length; beyond, the next step finds its length before it cuts
VANISHING = 1e-12  # share of a pressure that may be left by a step that makes it vanish
CERTAINTY = 2.0  # times the largest misfit; 1 is enough for all of tau's states on random scenes (tests)
UNDECIDED = 1e4  # share of the contact that a state of tau before the last may leave undecided, over the
#                  tolerance: a fifth less work on smooth contacts from 512 to 2048 elements a side. Of 64
#                  random contacts of 256 to 2048 one has another active set than with 0, by one element
MOST_UNDECIDED = 1e-4  # that share at most
LOAD_SLACK = (
    1e-3  # share of the load, taken from rising pressures only; 1e-2 to 1e-4 take as many steps within 0.5 %
)
LIST_SHARE = 0.35  # share of a window up to which lists are quicker: 0.35 at 256 elements a side, 0.45 at 512

# Lagged terms (`lagged_terms`)
NEGLIGIBLE_COUPLING = 0.1  # beta c / a up to which the coupling lags beside slopes: it saves 5 % of the work
#                            from 0.02 to 0.05, nothing from 0.1 to 0.2 (16 random contacts each)
WEAK_COUPLING = 0.3  # beta c / a up to which CG takes the coupling in; it pays to 0.5 and fails at 0.7
STEEPEST_COSINE = 1e-6  # cosine of slopes that have diverged, under pressures far beyond the moduli
LARGEST_DISPLACEMENT = (
    1e30  # domain sizes; larger shear displacements have diverged, squares are still doubles
)

# Anderson mixing (`anderson`)
DEPTH = 20  # differences kept: steep slopes on 1024 elements a side take 522 CG steps, 606 with 10
MIXING_SHARE = 0.5  # share of the remaining defect; 0.3 takes more steps, 1 stalled on 512 elements a side
DISTINCT = 1e-10  # least eigenvalue of the normalised products of differences that is more than rounding
STRONG_FEEDBACK = 0.3  # change of the residual by an update, over the last residual, that counts as strong
STRONG_UPDATES = 2  # strong updates in a row that start the mixing; one may be a contact that opens
STALLED = 5  # plain updates in a row without halving the best residual: they do not contract
RESTART = 10  # mixed updates in a row without halving it, before the history is dropped
PATIENCE = 30  # mixed updates in a row without halving it, before the solve has stagnated

# Plastic indentation and slopes, each from the other between two updates.
SETTLED = 0.01  # share of the first change that may be left: the updates reduce the rest
SETTLING_LIMIT = 30  # rounds
