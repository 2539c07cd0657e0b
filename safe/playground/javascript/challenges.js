// Challenges: questions that readers answer by what they do in the playground, and how the page knows that they have.
//
// Where chance has a part, so many runs count, with the seeds from 0 on. With few robots these take seconds.

import { readAddress, writeAddress } from "./address.js";
import { ALGORITHMS, PARAMETERS } from "./algorithms.js";
import { checksumOf } from "./class_lines.js";
import { Evolution } from "./evolution.js";
import { distanceBetween } from "./maze.js";
import { isNamed } from "./named_mazes.js";
import { Walker } from "./robot.js";
import { defaultState } from "./state.js";
import { successInterval } from "./statistics.js";

const NOTHING = "controller=0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0";
const FEW = "population=50&objectives=50&generations=100"; // robots

/** address: where a challenge begins. free: the parts that its solution may change, and parameters by name.
 * test: is it solved by a state, and by the outcomes of its runs, for each algorithm { algorithm, successes }? */
export const CHALLENGES = [
  {
    title: "Two weights",
    question: "Lead the robot to the goal of the empty room. At most two weights may differ from 0.",
    hint: "With all weights at 0 it goes right and down, and it passes the goal. What could turn it back?",
    address: `view=drive&maze=open&${NOTHING}`,
    free: ["controller"],
    test: ({ maze, controller }) => weightsOf(controller) <= 2 && reaches(maze, controller),
  },
  {
    title: "Out of the trap by hand",
    question: "Lead the robot to the goal of the trap. At most three weights may differ from 0.",
    hint: "You need no sensor of the goal for all of it. Begin with p7 = −1, and look for a way along the walls.",
    address: `view=drive&maze=trap&${NOTHING}`,
    free: ["controller"],
    test: ({ maze, controller }) => weightsOf(controller) <= 3 && reaches(maze, controller),
  },
  {
    title: "The first one out",
    question:
      "Stop this run of novelty search at the first generation in which any robot has come nearer to the goal " +
      "than the pocket allows: less than 7 cells.",
    hint: "Below the maze, the page says how near the best robot has come. One generation shows one at a time.",
    address: `view=watch&maze=trap&algorithm=novelty&seed=5&${FEW}`,
    free: ["generation"],
    test: isFirstOut,
  },
  {
    title: "Fool closeness",
    question: "Draw a maze of your own in which the standard evolutionary algorithm never succeeds in 20 runs.",
    hint: "What is near to the goal in a straight line, and far from it on foot? See what the spiral does.",
    address: `view=draw&maze=trap&algorithm=standard&runs=20&seed=0&${FEW}`,
    runs: 20,
    free: ["maze"],
    test: ({ maze }, [standard]) => !isNamed(maze) && standard.successes === 0,
  },
  {
    title: "Fool closeness, but not novelty",
    question:
      "Draw a maze of your own in which the standard evolutionary algorithm succeeds in at most 2 of 20 runs, " +
      "and novelty search in at least 8.",
    hint: "Novelty search needs time to look everywhere: keep the maze small, and the deception strong.",
    address: `view=draw&maze=trap&algorithm=standard&algorithm=novelty&runs=20&seed=0&${FEW}`,
    runs: 20,
    free: ["maze"],
    test: ({ maze }, [standard, novelty]) => !isNamed(maze) && standard.successes <= 2 && novelty.successes >= 8,
  },
  {
    title: "Forgetful novelty",
    question: "Make novelty search fail in the spiral, in all 20 runs, by k or the size of the archive alone.",
    hint: "What does a search for new places have to remember?",
    address: `view=runs&maze=spiral&algorithm=novelty&runs=20&seed=0&${FEW}`,
    runs: 20,
    free: ["k", "archive"],
    test: (_, [novelty]) => novelty.successes === 0,
  },
  {
    title: "A little novelty",
    question: "Objective functions with fixed coefficients [a, b] reward closeness and novelty. Find some with b > 0 " +
      "that succeed in at most 1 of 20 runs in the spiral.",
    hint: "The two coefficients stand in the address of the page, behind fixed:none. Which of them is too large?",
    address: `view=runs&maze=spiral&algorithm=fixed:none:0.5,0.5&runs=20&seed=0&${FEW}`,
    runs: 20,
    free: ["algorithms"],
    test: ({ algorithms: [{ objectives, kind, components }] }, [fixed]) =>
      kind === "weights" && `${components}` === "1 / distance,novelty" && objectives?.length === 1 &&
      objectives[0][1] > 0 && fixed.successes <= 1,
  },
  {
    title: "A small budget",
    question:
      "No run may try more than 2000 robots (population times generations). Succeed in at least 7 of 20 runs in " +
      "the trap, with any algorithm and parameters, as long as robots walk as far and success means the same.",
    hint: "What makes children differ more from their parents? And what does a reward for closeness do beside novelty?",
    address: "view=runs&maze=trap&algorithm=novelty&runs=20&seed=0&population=20&objectives=20&generations=100",
    runs: 20,
    free: ["algorithms", ...Object.keys(PARAMETERS).filter((name) => !["steps", "success_distance"].includes(name))],
    test: ({ parameters: { population = 200, generations = 500 } }, [one]) =>
      population * generations <= 2000 && one.successes >= 7,
  },
  {
    title: "SAFE ahead of novelty search",
    question: "Choose for SAFE what its objective functions weigh, what they are bred for and who judges, so that it " +
      "succeeds more often than novelty search in the spiral: after 40 runs their intervals must be apart.",
    hint:
      "Open Parameters with SAFE alone, then add novelty search as it is in the paper. A path visits more cells than its end.",
    address: `view=runs&maze=spiral&algorithm=safe&algorithm=novelty&runs=40&seed=0&${FEW}`,
    runs: 40,
    free: ["algorithms"],
    test: (_, outcomes) => {
      const novelty = outcomes.find(({ algorithm }) => algorithm === ALGORITHMS.novelty);
      const safe = outcomes.find(({ algorithm }) => algorithm.name === "safe" && algorithm.objectives === null);
      return Boolean(novelty && safe) && low(safe) > high(novelty);
    },
  },
  {
    title: "Judges for the trap",
    question: "Which objective functions of SAFE bring at least 30 of 40 runs to the goal of the trap?",
    hint: "What leads out of the pocket: closeness, new end points, or rare paths? Try them in pairs.",
    address: `view=runs&maze=trap&algorithm=safe&runs=40&seed=0&${FEW}`,
    runs: 40,
    free: ["algorithms"],
    test: (_, [safe]) => safe.algorithm.objectives === null && safe.successes >= 30,
  },
];

const HEAD_OF_CODE = "SAFE-challenges-1";

/** The state in which a challenge begins. */
export function beginningOf(challenge) {
  return { ...defaultState(), ...readAddress(challenge.address) };
}

/** Does a state solve a challenge? outcomes: of the runs of its settings, if they are over; see `CHALLENGES`. */
export function isSolved(challenge, state, outcomes) {
  const first = beginningOf(challenge), { free, runs } = challenge;
  const isAsFirst = (name) => free.includes(name) || textOfPart(state, name) === textOfPart(first, name);
  const areParametersFit = Object.keys(PARAMETERS).every((name) =>
    free.includes(name) || (state.parameters[name] ?? PARAMETERS[name]) === (first.parameters[name] ?? PARAMETERS[name])
  );
  if (!["maze", "algorithms", "seed"].every(isAsFirst) || !areParametersFit) return false;
  if (runs && !(outcomes?.length > 0 && outcomes.every((one) => one.runs === runs))) return false;
  return challenge.test(state, outcomes);
}

/** A part of a state as the address writes it. */
function textOfPart(state, name) {
  const parts = writeAddress({ ...state, view: "draw" }).split("&");
  const key = name === "algorithms" ? "algorithm" : name;
  return parts.filter((part) => part.startsWith(`${key}=`)).join();
}

/** The code that shows a teacher what was solved. solved: by the numbers of challenges, the addresses that solve them. */
export function writeCode(name, solved) {
  const text = [HEAD_OF_CODE, encodeURIComponent(name), ...Object.entries(solved).map((pair) => pair.join(":")), ""]
    .join(";");
  return `${text}${checksumOf(text)};`;
}

/** What a code says: { name, solved: [number, address] pairs }; null if it is damaged. */
export function readCode(text) {
  const code = text.replace(/\s/g, ""), parts = code.split(";");
  const body = parts.slice(0, -2).join(";") + ";";
  if (parts[0] !== HEAD_OF_CODE || parts.length < 4 || checksumOf(body) !== parts.at(-2)) return null;
  const solved = parts.slice(2, -2).map((part) => [Number(part.split(":")[0]), part.slice(part.indexOf(":") + 1)]);
  return { name: decodeURIComponent(parts[1]), solved };
}

function weightsOf(controller) {
  return controller.filter((weight) => weight !== 0).length;
}

function reaches(maze, controller) {
  const walker = new Walker(maze, PARAMETERS.steps);
  walker.walk(controller, 0);
  return distanceBetween(walker.position(PARAMETERS.steps), maze.goal) <= PARAMETERS.success_distance;
}

function isFirstOut({ maze, algorithms, seed, parameters, generation }) {
  const evolution = new Evolution(maze, algorithms[0], seed, parameters);
  while (evolution.best.distance >= 7 && !evolution.isOver) evolution.advance();
  return evolution.best.distance < 7 && evolution.number === generation;
}

function low({ successes, runs }) {
  return successInterval(successes, runs)[0];
}

function high({ successes, runs }) {
  return successInterval(successes, runs)[1];
}
