// A worker, as a page sees it (see worker.js).

const MOST_WORKERS = 8;

/** As many workers as the machine has cores, for so many jobs. */
export function makeClients(makeWorker, jobs) {
  const workers = Math.min(MOST_WORKERS, navigator.hardwareConcurrency || 2, jobs);
  return Array.from({ length: workers }, () => new WorkerClient(makeWorker));
}

export class WorkerClient {
  constructor(makeWorker) {
    this.waiting = new Map(); // by the number of a message, who waits for its answer
    this.sent = 0;
    try {
      this.worker = makeWorker();
    } catch {
      this.worker = null; // forbidden, as in some frames
      return;
    }
    this.worker.onmessage = ({ data: { id, answer, error } }) => {
      const { resolve, reject } = this.waiting.get(id);
      this.waiting.delete(id);
      if (error === undefined) resolve(answer);
      else reject(new Error(error));
    };
    this.worker.onerror = () => {
      for (const { reject } of this.waiting.values()) reject(cannotRun());
      this.waiting.clear();
    };
  }

  /** The answer to a task. */
  ask(task, settings) {
    if (!this.worker) return Promise.reject(cannotRun());
    return new Promise((resolve, reject) => {
      const id = this.sent++;
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, task, ...settings });
    });
  }

  /** Stop; whatever is not yet answered never will be. */
  close() {
    this.worker?.terminate();
    this.waiting.clear();
  }
}

function cannotRun() {
  return new Error("the browser cannot run the workers of this page, which do the computing");
}
