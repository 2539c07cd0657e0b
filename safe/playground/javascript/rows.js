// Matrices are typed arrays, row after row; these are their rows as plain arrays.

/** The i-th row of a matrix. */
export function rowOf(matrix, i, columns) {
  return Array.from(matrix.subarray(i * columns, (i + 1) * columns));
}

/** All rows of a matrix. */
export function rowsOf(matrix, columns) {
  return Array.from({ length: matrix.length / columns }, (_, i) => rowOf(matrix, i, columns));
}
