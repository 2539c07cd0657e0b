"""The playground: its JavaScript, the addresses of runs in it, and the widget that shows it in Jupyter."""
