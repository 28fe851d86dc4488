/**
 * Small dense linear algebra: matrices are stored row by row in one array. Results are written into
 * arrays of the caller, which may be longer than needed, since this runs in every frame.
 */

/**
 * Solve A x = b for a symmetric positive definite A, n by n, by Cholesky's L L' and store x in b.
 *
 * A is overwritten; only its lower triangle is read.
 */
export function solveInPlace(matrix: Float64Array, right: Float64Array, n: number): void {
  for (let row = 0; row < n; row++) {
    for (let column = 0; column <= row; column++) {
      let sum = matrix[row * n + column] as number;
      for (let k = 0; k < column; k++) {
        sum -= (matrix[row * n + k] as number) * (matrix[column * n + k] as number);
      }
      matrix[row * n + column] =
        row === column ? Math.sqrt(sum) : sum / (matrix[column * n + column] as number);
    }
  }
  for (let row = 0; row < n; row++) {
    let sum = right[row] as number;
    for (let k = 0; k < row; k++) sum -= (matrix[row * n + k] as number) * (right[k] as number);
    right[row] = sum / (matrix[row * n + row] as number);
  }
  for (let row = n - 1; row >= 0; row--) {
    let sum = right[row] as number;
    for (let k = row + 1; k < n; k++) sum -= (matrix[k * n + row] as number) * (right[k] as number);
    right[row] = sum / (matrix[row * n + row] as number);
  }
}

/** Write the residual b - A x into `left`; as many unknowns as `left` is long. */
export function writeResidual(
  matrix: Float64Array,
  right: Float64Array,
  x: Float64Array,
  left: Float64Array,
): void {
  const n = left.length;
  for (let row = 0; row < n; row++) {
    let sum = right[row] as number;
    for (let k = 0; k < n; k++) sum -= (matrix[row * n + k] as number) * (x[k] as number);
    left[row] = sum;
  }
}

/** Write J' J, both triangles, into `product`, for a J of so many rows and columns. */
export function writeGram(
  jacobian: Float64Array,
  rows: number,
  columns: number,
  product: Float64Array,
): void {
  product.fill(0);
  for (let start = 0; start < rows * columns; start += columns) {
    for (let i = 0; i < columns; i++) {
      const factor = jacobian[start + i] as number;
      if (factor === 0) continue;
      for (let j = 0; j <= i; j++) {
        const at = i * columns + j;
        product[at] = (product[at] as number) + factor * (jacobian[start + j] as number);
      }
    }
  }
  for (let i = 0; i < columns; i++) {
    for (let j = 0; j < i; j++) product[j * columns + i] = product[i * columns + j] as number;
  }
}

/** Write J' e into `product`, for a J of so many rows and columns. */
export function writeTransposedTimes(
  jacobian: Float64Array,
  error: Float64Array,
  rows: number,
  columns: number,
  product: Float64Array,
): void {
  product.fill(0);
  for (let row = 0; row < rows; row++) {
    const factor = error[row] as number;
    for (let column = 0; column < columns; column++) {
      const entry = jacobian[row * columns + column] as number;
      product[column] = (product[column] as number) + entry * factor;
    }
  }
}
