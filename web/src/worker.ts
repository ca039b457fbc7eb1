// ELK's worker. In a worker it answers messages; a page from files calls it directly.

import * as worker from "elkjs/lib/elk-worker.min.js";

const made = worker as { Worker?: new (url: string | undefined) => Worker };
if (typeof document !== "undefined" && made.Worker !== undefined) globalThis.layoutWorker = made.Worker;
