// Answers one line after the other.

import { createInterface } from "node:readline";
import { answer } from "./call.mjs";

for await (const line of createInterface({ input: process.stdin })) process.stdout.write(answer(line) + "\n");
