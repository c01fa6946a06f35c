"""What a scene requires, judged before it is solved: the contact to expect, and what each term does to it."""
