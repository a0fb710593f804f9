// Lists of numbers that grow while a run goes on: rows of a fixed width in one typed array.

type Numbers = Float32Array | Float64Array;

/** Rows of `width` numbers. */
export class Rows<A extends Numbers> {
  n = 0;
  private constructor(readonly width: number, private data: A, private readonly make: (n: number) => A) {}

  static singles(width: number): Rows<Float32Array> {
    return new Rows(width, new Float32Array(0), (n) => new Float32Array(n));
  }

  static doubles(width: number): Rows<Float64Array> {
    return new Rows(width, new Float64Array(0), (n) => new Float64Array(n));
  }

  /** Adds whole rows. */
  push(rows: A): void {
    const used = this.n * this.width;
    const needed = used + rows.length;
    if (needed > this.data.length) {
      const larger = this.make(Math.max(needed, 2 * this.data.length));
      larger.set(this.data.subarray(0, used));
      this.data = larger;
    }
    this.data.set(rows, used);
    this.n += this.width > 0 ? rows.length / this.width : 0;
  }

  at(row: number, column: number): number {
    return this.data[row * this.width + column] as number;
  }

  /** The column as a list of its own. */
  column(column: number): Float64Array {
    const out = new Float64Array(this.n);
    for (let k = 0; k < this.n; k++) out[k] = this.at(k, column);
    return out;
  }

  /** Forgets the rows from `n` on. */
  truncate(n: number): void {
    this.n = Math.min(this.n, n);
  }

  /** All that is there, without a copy. */
  view(): A {
    return this.data.subarray(0, this.n * this.width) as A;
  }
}

/** How many of the sorted `times` are at or before `t`. */
export function countUpTo(times: ArrayLike<number>, n: number, t: number): number {
  let low = 0;
  let high = n;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) <= t) low = middle + 1;
    else high = middle;
  }
  return low;
}
