"""Many independent runs.

provenance.py   which sources, versions, commit and platform made runs
database.py     the SQLite file of a store: its tables, and how it is opened for writing and for reading
store.py        holds finished runs in such a file
progress.py     the progress bar
cores.py        how many cores this process may use
dispatch.py     sends runs to an executor and stores them as they come back
experiment.py   Experiment, its runs, and their table
exchange.py     merges stores, and verifies one by making runs again
"""
