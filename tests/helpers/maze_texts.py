"""Texts of mazes, each with a plain one of the same maze, and texts of none, each with the complaint, a pattern."""

SMALL = "S.#\n..G"
SMALL_LIST = "size 2,3\nstart 0,0\ngoal 1,2\nwall 0,2 0,2\n"
SAME_DRAWINGS = [
    ("201\n003", SMALL),
    ("s.x\n..g", SMALL),
    ("S.X\n..e", SMALL),
    ("20█\n00E", SMALL),
    ("S ▓\n  G", SMALL),
    ("  S.#  \n\n\t..G\t\n\n", SMALL),
    ("\u3000S.#\xa0\n\u2003..G\u3000", SMALL),
    ("\ufeffS.#\r\n..G\r\n\x1a", SMALL),
    ("S.#\r..G\r", SMALL),
    ("S.#\n..G\n\x1awhatever follows", SMALL),
    ("+--+\n|SE|\n+--+", "####\n#SG#\n####"),
    ("┌──┐\n│ S│\n│G ╞\n└──┘", "####\n#.S#\n#G.#\n####"),
    ("■■■■■\n■S G■\n■■■■■", "#####\n#S.G#\n#####"),
    ("XXXXX\n    XS GX\n    XXXXX", "#####\n#S.G#\n#####"),  # the first line behind the quotes of a Python text
    ("#\xa0S\n#\u3000G", "#.S\n#.G"),
    # blanks around rows that an editor has removed, or not
    ("  #####\n  #S\n  #  ##\n   # G\n", "#####\n#S...\n#..##\n.#.G."),
    ("  #####   \n  #S\n  #  ##\t\n   # G", "#####\n#S...\n#..##\n.#.G."),
    ("   #  G\n S\n", "..#..G\nS....."),
    ("\t #  G\n\tS\n", ".#..G\nS...."),
]
BAD_DRAWINGS = [
    ("", "at least one row; got none"),
    ("\x1aS.G", "at least one row; got none"),
    ("S..\n..", "rectangle; got 2 cells wide in row 2, 3 in row 1"),
    ("#S#\n#G", "rectangle; got 2 cells wide in row 2, 3 in row 1"),
    ("S.?G", r"^a maze must be a drawing in .*, or a list .*, or line segments; got '\?' in row 1$"),
    ("_ _\n|S|_\n|_G", "got '_' in row 1"),
    ("░S░\n░G░", "got '░' in row 1"),
    ("S\tG", r"got '\\t' in row 1"),
    ("#S #\n#\tG#", r"got '\\t' in row 2"),
    ("size3,3\nstart 0,0", "got 'i' in row 1"),
    ("S G\n..#", "open cells by blanks, or by . and 0; got blanks, and one of these in row 2"),
    ("0 1 0 S\n0 0 0 G", "open cells by blanks, or by . and 0; got blanks, and one of these in row 1"),
    ("#S #\n\t# G", "indented by the same tabs in all rows if blanks are open cells; got another in row 2"),
    ("S #\n\n# G", "no blank line between its rows if blanks are open cells; got one in line 2"),
    ("\n#S #\n#  #\n  \n# G#", "no blank line between its rows if blanks are open cells; got one in line 4"),
    ("S...", "exactly one goal; got 0"),
    ("...G", "exactly one start; got 0"),
    ("S.SG", "exactly one start; got 2"),
    ("S.EG", "exactly one goal; got 2"),
    ("S#G", r"goal must be reachable from the start \(0, 0\) through open cells; got \(0, 2\)"),
    ("S#\n#G", "goal must be reachable"),
    ("S" + 2047 * "." + "G", "the drawing of a maze must be 1 to 2048 cells a side; got 1,2049"),
]

SAME_LISTS = [
    (SMALL_LIST, SMALL),
    ("\ufeff" + SMALL_LIST.replace("\n", "\r\n") + "\x1a", SMALL),
    (SMALL_LIST.replace("\n", "\r"), SMALL),
    (SMALL_LIST.replace(",", ", "), SMALL),
    (SMALL_LIST.replace(",", "\t,\xa0\u3000"), SMALL),
    (SMALL_LIST.replace(" ", "\t").replace("\n", " \t\n"), SMALL),
    (SMALL_LIST.replace(" ", "\u3000"), SMALL),
    (SMALL_LIST.replace("\n", "# caf\ufffd, 5\n"), SMALL),
    ("size 4,5\nstart 0,0\ngoal 3,4\nwall 0,1 2,3  # a diagonal\nwall 3,0 3,1\n", "S#...\n..#..\n...#.\n##..G"),
    ("size 3,5\nstart 0,3\ngoal 1,4\nwall 0,0 2,4", "##.S.\n.###G\n...##"),  # a wall of another direction
    ("size 3,5\nstart 0,3\ngoal 1,4\nwall 2,4 0,0", "##.S.\n.###G\n...##"),  # and the other way round
    ("size 4,2\nstart 1,1\ngoal 0,1\nwall 3,1 0,0", "#G\n#S\n.#\n.#"),
]
GOOD = "size 3,3\nstart 0,0\ngoal 2,2\n"
BAD_LISTS = [
    (GOOD.replace("goal 2,2\n", ""), "must give the goal; got none"),
    (GOOD.replace("start 0,0\n", ""), "must give the start; got none"),
    (GOOD + "size 3,3", "size must be given once; got it again in line 4"),
    (GOOD + "door 1,1", "must begin with size, start, goal or wall; got 'door' in line 4"),
    (GOOD + "wall 1,1", "wall must be followed by row,column row,column; got something else in line 4"),
    (GOOD + "wall 1,1 1,x", "wall must be followed by row,column row,column; got '1,x' in line 4"),
    (GOOD + "wall 1,1, 1,2", "wall must be followed by row,column row,column; got something else in line 4"),
    (GOOD + "wall 0,1 -1,1", "got '-1,1' in line 4"),
    (GOOD + "wall 0,1 １,1", "got '１,1' in line 4"),
    (GOOD + "wall 1,1 1,3", "wall must lie within the 3 by 3 cells; got 1,3 in line 4"),
    (GOOD + "wall 0,0 0,1", r"start must be an open cell; got \(0, 0\), which is wall"),
    (GOOD + "wall 2,2 2,2", r"goal must be an open cell; got \(2, 2\), which is wall"),
    (GOOD + "wall 0,1 2,1", "goal must be reachable"),
    (GOOD + "wall 0,1 1,0", "goal must be reachable"),
    (GOOD.replace("2,2", "0,0"), "goal must differ from the start"),
    (GOOD.replace("2,2", "3,0"), r"goal must be a \(row, column\) within the 3 by 3 cells; got \(3, 0\)"),
    (GOOD.replace("3,3", "0,3"), "size must be 1 to 2048 cells a side; got 0,3"),
    (GOOD.replace("3,3", "9999,9999"), "size must be 1 to 2048 cells a side"),
    (GOOD.replace("3,3", "9999999999999,3"), "size must be followed by height,width"),
    ("\0".join(GOOD), "a maze file must be text in UTF-8, or in UTF-16 with a byte order mark; got NUL characters"),
]

SEGMENTS = "2\n1 1\n0\n9 2\n0 0 10 0\n5 0 5 1\n"
SEGMENTS_LIST = "size 21,100\nstart 10,10\ngoal 20,89\nwall 0,0 0,99\nwall 0,50 10,50\n"  # 49.5 is rounded up
SAME_SEGMENTS = [
    (SEGMENTS, SEGMENTS_LIST),
    (f"0\n600\n{SEGMENTS}", SEGMENTS_LIST),  # a switch, steps
    (SEGMENTS.replace("9 2\n", "9 2\n9 2\n"), SEGMENTS_LIST),  # a point of interest
    ("# walls\n" + SEGMENTS.replace("\n", "  # café\n\n"), SEGMENTS_LIST),
    (SEGMENTS.replace(" ", ", ").replace("\n", "\r\n") + "\x1a", SEGMENTS_LIST),
    ("2.0e+00\n1 1.\n0\n9\t2e0\n0 -0 1.0e1 0\n5 0 5 1\n", SEGMENTS_LIST),
    ("2\n-4 101\n90.5\n4 102\n-5 100 5 100\n+0.0 100 0 101", SEGMENTS_LIST),
    ("0\n0 0\n0\n0 0.5", "size 100,1\nstart 0,0\ngoal 99,0"),
]
BAD_SEGMENTS = [
    ("1 1\n0\n9 1", r"line segments must be lines of 1, 2, 1, 2 and then 4 numbers: .*; got \[2, 1, 2\] numbers"),
    (SEGMENTS.replace("1 1\n0\n", "0\n1 1\n"), r"got \[1, 1, 2, 2, 4, 4\] numbers"),
    (SEGMENTS.replace("5 0 5 1", "5 0 5"), r"got \[1, 2, 1, 2, 4, 3\] numbers"),
    (SEGMENTS + "9 9\n", r"got \[1, 2, 1, 2, 4, 4, 2\] numbers"),
    (SEGMENTS[: SEGMENTS.index("9 2")], r"got \[1, 2, 1\] numbers"),
    ("11111\n12 31\n11111", r"got \[1, 2, 1\] numbers"),  # digits have 0 for open cells
    (SEGMENTS + "1 1 9 9\n", "line segments must be as many as the line before the start says; got 3"),
    (SEGMENTS.replace("9 2", "1 1"), r"goal must differ from the start; got \(10, 10\) for both"),
    ("0\n3 3\n0\n3 3", r"goal must differ from the start; got \(0, 0\) for both"),
    (SEGMENTS.replace("9 2", "5 1"), r"goal must be an open cell; got \(10, 50\), which is wall"),
    (SEGMENTS.replace("9 2", "9 2e100"), "a maze must be a drawing in"),
    (SEGMENTS.replace("9 2", "9 nan"), "a maze must be a drawing in"),
]

SAME = SAME_DRAWINGS + SAME_LISTS + SAME_SEGMENTS
BAD = BAD_DRAWINGS + BAD_LISTS + BAD_SEGMENTS

COMMENTED = SMALL_LIST + "# café … 5\n"
SAME_FILES = [  # their bytes
    COMMENTED.encode("utf-8"),
    COMMENTED.encode("utf-8-sig"),
    COMMENTED.encode("cp1252"),
    COMMENTED.encode("cp437", "replace"),
    b"\xff\xfe" + COMMENTED.encode("utf-16-le"),
    b"\xfe\xff" + COMMENTED.encode("utf-16-be"),
    SMALL.replace("#", "█").encode("utf-16"),
]
BAD_FILES = [
    (COMMENTED.encode("utf-16") + b"!", r"must begin with size, start, goal or wall; got '\ufffd' in line 6"),
    (COMMENTED.encode("utf-16-le"), "a maze file must be text in UTF-8, or in UTF-16 with a byte order mark; got NUL"),
    (bytes(range(128, 256)), r"a maze must be a drawing in .*; got '\ufffd' in row 1"),
    ("S…\n.G".encode("cp1252"), r"a maze must be a drawing in .*; got '\ufffd' in row 1"),
    (SMALL_LIST.replace("0,2", "0\xa0,2").encode("cp1252"), "wall must be followed by row,column row,column; got"),
]
