"""Studies made with the program: the thesis' own estimator and tables, held beside ours."""
