"""Many independent runs: dispatched to executors, kept in a store, merged and verified."""
