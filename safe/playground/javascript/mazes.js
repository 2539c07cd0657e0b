// Mazes to choose from: the paper's two, as in the package, and others to compare them with.

export const MAZES = {
  maze1: `size 100,100
start 53,5
goal 41,15
wall 0,0 0,99
wall 0,99 99,99
wall 99,0 99,99
wall 0,0 99,0
wall 6,18 23,18
wall 12,44 12,56
wall 12,44 17,44
wall 17,8 39,8
wall 17,34 17,62
wall 17,34 35,34
wall 25,63 31,63
wall 28,86 31,86
wall 31,52 31,86
wall 31,52 49,52
wall 35,34 35,52
wall 37,79 43,79
wall 39,4 39,30
wall 39,30 45,30
wall 43,52 43,79
wall 49,1 49,52
wall 49,52 63,66
wall 55,58 55,81
wall 55,74 63,66
wall 61,31 61,64
wall 61,50 68,50
wall 68,31 68,63
wall 68,31 78,31
wall 68,63 77,63
wall 77,63 89,51
wall 78,16 78,31
wall 89,33 89,51
`,
  maze2: `size 100,100
start 8,80
goal 31,32
wall 0,0 0,99
wall 0,99 99,99
wall 99,0 99,99
wall 0,0 99,0
wall 6,22 6,68
wall 6,68 14,76
wall 7,70 13,76
wall 9,16 9,55
wall 9,55 18,64
wall 10,57 19,66
wall 13,9 13,50
wall 13,49 17,53
wall 13,50 18,55
wall 13,76 31,76
wall 17,55 52,55
wall 18,66 67,66
wall 20,1 20,41
wall 20,40 27,47
wall 20,41 28,49
wall 24,4 24,27
wall 24,26 29,31
wall 24,27 29,32
wall 27,49 73,49
wall 29,33 29,33
wall 29,34 85,34
wall 31,76 31,92
wall 39,66 39,85
wall 52,34 52,41
wall 52,55 52,59
wall 63,8 63,23
wall 63,23 76,23
wall 67,66 67,84
wall 73,49 73,68
wall 73,68 79,68
wall 76,9 76,34
wall 78,34 78,46
wall 79,58 79,92
wall 79,58 85,58
wall 85,34 94,25
wall 85,58 85,68
`,
  trap: `size 41,41
start 20,4
goal 20,34
wall 0,0 0,40
wall 40,0 40,40
wall 0,0 40,0
wall 0,40 40,40
wall 9,10 9,28
wall 31,10 31,28
wall 9,28 31,28
`,
  spiral: `size 41,41
start 2,2
goal 20,20
wall 0,0 0,40
wall 40,0 40,40
wall 0,0 40,0
wall 0,40 40,40
wall 5,5 5,35
wall 5,35 35,35
wall 35,5 35,35
wall 10,5 35,5
wall 10,5 10,30
wall 10,30 30,30
wall 30,10 30,30
wall 15,10 30,10
wall 15,10 15,25
wall 15,25 25,25
wall 25,15 25,25
wall 20,15 25,15
`,
  rooms: `size 43,43
start 4,4
goal 38,38
wall 0,0 0,42
wall 42,0 42,42
wall 0,0 42,0
wall 0,42 42,42
wall 1,14 9,14
wall 12,14 34,14
wall 37,14 41,14
wall 1,28 5,28
wall 8,28 20,28
wall 23,28 41,28
wall 14,1 14,6
wall 14,9 14,20
wall 14,23 14,41
wall 28,1 28,10
wall 28,13 28,34
wall 28,37 28,41
`,
  open: `size 41,41
start 4,4
goal 34,30
wall 0,0 0,40
wall 40,0 40,40
wall 0,0 40,0
wall 0,40 40,40
`,
};
