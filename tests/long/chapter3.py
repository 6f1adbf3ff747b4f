"""The long runs of Chapter 3."""

CASES = {}
