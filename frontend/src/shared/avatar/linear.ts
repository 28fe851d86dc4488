/** Small dense linear algebra: matrices are stored row by row in one array. */

/**
 * Solve A x = b for a symmetric positive definite A by Cholesky's L L' and store x in b.
 *
 * A is overwritten; only its lower triangle is read.
 */
export function solveInPlace(matrix: Float64Array, right: Float64Array): void {
  const n = right.length;
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

/** The residual b - A x. */
export function residual(matrix: Float64Array, right: Float64Array, x: Float64Array): Float64Array {
  const n = right.length;
  const left = Float64Array.from(right);
  for (let row = 0; row < n; row++) {
    let sum = right[row] as number;
    for (let k = 0; k < n; k++) sum -= (matrix[row * n + k] as number) * (x[k] as number);
    left[row] = sum;
  }
  return left;
}

/** J' J, both triangles, for a J with so many columns. */
export function gram(jacobian: Float64Array, columns: number): Float64Array {
  const product = new Float64Array(columns * columns);
  for (let start = 0; start < jacobian.length; start += columns) {
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
  return product;
}

/** J' e, for a J with so many columns. */
export function transposedTimes(
  jacobian: Float64Array,
  error: Float64Array,
  columns: number,
): Float64Array {
  const product = new Float64Array(columns);
  for (let row = 0; row < error.length; row++) {
    const factor = error[row] as number;
    for (let column = 0; column < columns; column++) {
      const entry = jacobian[row * columns + column] as number;
      product[column] = (product[column] as number) + entry * factor;
    }
  }
  return product;
}
