// Where robots end, as the package has it for readers. The playground does without.

import { checkedInteger, checkedRows, MOST } from "./checks.js";
import { STEPS, Walker, WEIGHTS } from "./robot.js";

/** Where each of n robots ends, [row, column] each. */
export function endpoints(maze, controllers, steps = STEPS) {
  const walker = new Walker(maze, checkedInteger("steps", steps, 0, MOST));
  const genomes = checkedRows("controllers", controllers, WEIGHTS, -1, 1);
  return controllers.map((_, i) => {
    walker.walk(genomes, WEIGHTS * i);
    return walker.position(steps);
  });
}
