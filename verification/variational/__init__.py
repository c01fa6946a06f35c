"""The variational competitor of Table 2: general minimisers of the complementary energy, and their timing."""
