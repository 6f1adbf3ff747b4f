"""The long runs of Chapter 2."""

CASES = {}
