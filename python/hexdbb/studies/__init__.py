"""Studies made with the program: the thesis' own estimator and tables, compared with ours."""
