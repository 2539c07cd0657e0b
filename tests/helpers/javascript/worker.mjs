// Answers one message after the other.

import { answer } from "./call.mjs";

onmessage = ({ data }) => postMessage(answer(data));
