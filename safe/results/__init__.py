"""What runs say: samples compared, tables, figures. Nothing here runs an experiment."""
