// Weights to start from.

const ON_MEANS = "A mean of solutions need not be one: where the robot goes depends on how the weights fit together.";

/** { title, explanation, controller }, or { title, explanation, run } if the weights are the best of a run, whose
 * algorithm and seed `run` gives for a maze. */
export const PRESETS = [
  {
    title: "a wall follower",
    explanation: "It goes right wherever it can. If a wall stops it, it follows the wall down until the wall ends. " +
      "With more room to the right than above, it goes up.",
    controller: [0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0],
  },
  {
    title: "the mean of successful runs of SAFE on maze1 (the paper's Table 3)",
    explanation: ON_MEANS,
    controller: [0.68, -0.56, 0.11, -0.04, -0.65, -0.73, 0.45, 0.33, 0.65, 0.62, -0.4, -0.55, -0.24, 0.03, -0.64, 0.41],
  },
  {
    title: "the mean of successful runs of SAFE on maze2 (the paper's Table 3)",
    explanation: ON_MEANS,
    controller: [-0.27, 0.04, -0.82, 0.52, 0.58, 0.38, 0.11, -0.37, 0.1, -0.09, 0.78, 0.54, 0.11, -0.15, -0.21, -0.15],
  },
  {
    title: "the best of a run of SAFE on this maze",
    explanation: "It was evolved just now, in this page: the best controller of one run.",
    run: ({ name }) => ({ algorithm: "safe", seed: name === "maze2" ? 22 : 32 }), // these succeed on the paper's mazes
  },
  {
    title: "all zero",
    explanation: "Both sums are 0 everywhere, and the robot goes right and down.",
    controller: Array(16).fill(0),
  },
];
