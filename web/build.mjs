// Builds the page into the Python package that serves it, with the licenses of the bundled packages.
import { build } from "esbuild";
import { copyFile, mkdir, readdir, readFile, writeFile } from "node:fs/promises";
import { resolve } from "node:path";

const source = new URL("./", import.meta.url).pathname;
const target = new URL("../robosc/tools/view/built/", import.meta.url).pathname;

await mkdir(target, { recursive: true });
const { metafile } = await build({
  entryPoints: { page: `${source}src/page.ts`, layout: `${source}src/worker.ts` },
  outdir: target,
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  legalComments: "eof",
  metafile: true,
});
for (const name of ["index.html", "page.css", "icon.svg"]) {
  await copyFile(`${source}src/${name}`, `${target}${name}`);
}
await writeFile(`${target}LICENSES.txt`, await licences(Object.keys(metafile.inputs)));

/** The bundled packages with their licenses. Throws an error if a package has none. */
async function licences(inputs) {
  const folders = new Set(inputs.map((input) => resolve(input).match(/^.*\/node_modules\/(?:@[^/]+\/)?[^/]+/)?.[0]).filter(Boolean));
  const texts = ["The page of `robosc view` is a part of RoboSC, under the licence of RoboSC. It contains these packages, unchanged but for their layout.\n"];
  for (const folder of [...folders].sort()) {
    const { name, version, license, repository } = JSON.parse(await readFile(`${folder}/package.json`, "utf8"));
    const files = (await readdir(folder)).filter((file) => /^(licen[cs]e|notice)/i.test(file)).sort();
    if (license === undefined || files.length === 0) throw new Error(`${name} says nothing of its licence`);
    const source = (repository?.url ?? repository ?? "").replace(/^git\+/, "");
    texts.push(`${name} ${version}\nLicence: ${license}\nSource: ${source}\n`);
    for (const file of files) texts.push(await readFile(`${folder}/${file}`, "utf8"));
  }
  return texts.join(`\n${"-".repeat(80)}\n\n`);
}
