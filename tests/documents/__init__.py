"""Pages held against the program: the commands they show, and what these print."""
