// Novelty by itself, as the package has it for readers. The playground does without.

import { checkedChoice, checkedInteger, checkedRows, MOST } from "./checks.js";
import { Archive, ARCHIVE_CAPACITY, K, scorePoints } from "./novelty.js";
import { rowOf } from "./rows.js";

/** An archive of points, and the novelty of new ones: as safe.NoveltyArchive. */
export class NoveltyArchive {
  constructor(capacity = ARCHIVE_CAPACITY, k = K, metric = "taxicab") {
    this.capacity = checkedInteger("capacity", capacity, 0, MOST);
    this.k = checkedInteger("k", k, 1, MOST);
    this.metric = checkedChoice("metric", metric, ["taxicab", "euclidean"]);
    this.archive = null; // made with the first points, which give the dimensions
  }

  /** The novelty of one generation of points, in order; what the archive admits of it stays there. */
  score(points) {
    const dimensions = this.archive?.dimensions ?? points?.[0]?.length ?? 0;
    const flat = checkedRows("points", points, dimensions);
    checkedInteger("the columns of points", dimensions, 1, 1000);
    this.archive ??= new Archive(this.capacity, dimensions);
    const scores = new Float64Array(points.length);
    scorePoints(flat, this.archive, this.k, this.metric === "taxicab", scores);
    return [...scores];
  }

  get length() {
    return this.archive?.size ?? 0;
  }

  /** The points in the archive, the oldest first. */
  get points() {
    return this.archive ? listed(this.archive).points : [];
  }

  /** The scores that they entered with. */
  get scores() {
    return this.archive ? listed(this.archive).scores : [];
  }
}

/** The points and scores of an archive, the oldest first, as plain arrays. */
export function listed({ points, scores, entry, size, dimensions }) {
  const places = Array.from({ length: size }, (_, place) => place).sort((a, b) => entry[a] - entry[b]);
  return {
    points: places.map((place) => rowOf(points, place, dimensions)),
    scores: places.map((place) => scores[place]),
  };
}
