"""Texts that hold no maze, each with the complaint about it, a regular expression."""

BAD_DRAWINGS = [
    ("", "at least one row; got none"),
    ("S..\n..", "rectangle; got 2 cells wide in row 2, 3 in row 1"),
    ("S.?G", r"only . 0 # 1 S 2 G 3; got '\?' in row 1"),
    ("S...", "exactly one goal; got 0"),
    ("...G", "exactly one start; got 0"),
    ("S.SG", "exactly one start; got 2"),
    ("S#G", r"goal must be reachable from the start \(0, 0\) through open cells; got \(0, 2\)"),
    ("S#\n#G", "goal must be reachable"),
]

GOOD = "size 3,3\nstart 0,0\ngoal 2,2\n"
BAD_LISTS = [
    (GOOD.replace("goal 2,2\n", ""), "must give the goal; got none"),
    (GOOD.replace("start 0,0\n", ""), "must give the start; got none"),
    (GOOD + "size 3,3", "size must be given once; got it again in line 4"),
    (GOOD + "door 1,1", "must begin with size, start, goal or wall; got 'door' in line 4"),
    (GOOD + "wall 1,1", "wall must be followed by row,column row,column; got something else in line 4"),
    (GOOD + "wall 1,1 1,x", "wall must be followed by row,column row,column; got '1,x' in line 4"),
    (GOOD + "wall 0,1 -1,1", "got '-1,1' in line 4"),
    (GOOD + "wall 1,1 1,3", "wall must lie within the 3 by 3 cells; got 1,3 in line 4"),
    (GOOD + "wall 0,1 2,2", "wall must be horizontal, vertical or diagonal; got something else in line 4"),
    (GOOD + "wall 0,0 0,1", r"start must be an open cell; got \(0, 0\), which is wall"),
    (GOOD + "wall 2,2 2,2", r"goal must be an open cell; got \(2, 2\), which is wall"),
    (GOOD + "wall 0,1 2,1", "goal must be reachable"),
    (GOOD.replace("2,2", "0,0"), "goal must differ from the start"),
    (GOOD.replace("2,2", "3,0"), r"goal must be a \(row, column\) within the 3 by 3 cells; got \(3, 0\)"),
    (GOOD.replace("3,3", "0,3"), "size must be 1 to 2048 cells a side; got 0,3"),
    (GOOD.replace("3,3", "9999,9999"), "size must be 1 to 2048 cells a side"),
    (GOOD.replace("3,3", "9999999999999,3"), "size must be followed by height,width"),
]
