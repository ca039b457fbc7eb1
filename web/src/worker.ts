// ELK's worker. In a worker it answers messages; in a page from files it is called as if it were one.

import * as worker from "elkjs/lib/elk-worker.min.js";

const made = worker as { Worker?: new (url: string | undefined) => Worker };
if (typeof document !== "undefined" && made.Worker !== undefined) globalThis.layoutWorker = made.Worker;
