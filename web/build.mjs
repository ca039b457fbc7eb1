// Builds the page into the Python package that serves it.
import { build } from "esbuild";
import { copyFile, mkdir } from "node:fs/promises";

const source = new URL("./", import.meta.url).pathname;
const target = new URL("../robosc/view/built/", import.meta.url).pathname;

await mkdir(target, { recursive: true });
await build({
  entryPoints: { page: `${source}src/page.ts`, layout: `${source}src/worker.ts` },
  outdir: target,
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  legalComments: "eof",
});
for (const name of ["index.html", "page.css", "icon.svg"]) {
  await copyFile(`${source}src/${name}`, `${target}${name}`);
}
