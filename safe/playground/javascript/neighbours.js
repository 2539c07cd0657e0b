// The nearest neighbours of points, found by measuring all distances (safe/neighbours.py finds the same in a grid).

/** Put the `wanted` smallest distances between the i-th and all of the first `size` members, in order, into `nearest`.
 *
 * Euclidean distances stay squared: the order is the same. */
export function nearestDistances(axes, i, size, wanted, taxicab, nearest) {
  const [xs, ys, ...others] = axes, x = xs[i], y = ys[i];
  const last = wanted - 1;
  let farthest = Infinity; // of those in `nearest`
  nearest.fill(Infinity);
  for (let j = 0; j < size; j++) {
    const dx = xs[j] - x, dy = ys[j] - y;
    let distance = taxicab ? Math.abs(dx) + Math.abs(dy) : dx * dx + dy * dy;
    if (others.length > 0) {
      for (const axis of others) {
        const difference = axis[j] - axis[i];
        distance += taxicab ? Math.abs(difference) : difference * difference;
      }
    }
    if (distance < farthest) {
      let place = last;
      for (; place > 0 && nearest[place - 1] > distance; place--) nearest[place] = nearest[place - 1];
      nearest[place] = distance;
      farthest = nearest[last];
    }
  }
}
