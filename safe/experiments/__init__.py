"""Many independent runs.

store.py        one SQLite file that holds finished runs
provenance.py   which versions, commit and platform made them
progress.py     the progress bar
dispatch.py     sends runs to an executor and stores them as they come back
experiment.py   Experiment, its runs, and their table
exchange.py     merges stores, and verifies one by making runs again
"""
