// node build.mjs FOLDER
// Bundles script, style and template of the report into FOLDER/page.html, which needs no network.
// It still has a placeholder where the simulator puts the report's JSON. The live page, which comes
// from a server, is FOLDER/live.html, live.js and live.css.

import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const PLACEHOLDER = '@VOLCOMP_REPORT_DATA@';
const here = (name) => new URL(name, import.meta.url);

async function bundle(entry) {
  const result = await build({
    entryPoints: [fileURLToPath(here(entry))], bundle: true, minify: true, write: false,
    format: 'iife', target: 'es2022', charset: 'ascii', legalComments: 'none', logLevel: 'warning',
    define: { 'process.env.NODE_ENV': '"production"' },
  });
  return result.outputFiles[0].text.trim();
}

// The licences of what is inside the bundle ask to go with every copy of it.
async function licences() {
  const files = [
    'echarts/NOTICE', 'echarts/LICENSE', 'zrender/LICENSE', 'tslib/LICENSE.txt',
  ];
  const texts = await Promise.all(files.map((name) => readFile(here(`node_modules/${name}`), 'utf8')));
  return files.map((name, index) => `==== ${name} ====\n${texts[index].trim()}\n`).join('\n').replaceAll('</script', '');
}

// Replaces with a function, as "$&" in the bundle would be read as a pattern.
async function page() {
  const parts = {
    '@STYLE@': await readFile(here('style.css'), 'utf8'),
    '@SCRIPT@': await bundle('page.mjs'),
    '@LICENCES@': await licences(),
  };
  const template = await readFile(here('template.html'), 'utf8');
  return template.replace(/@(STYLE|SCRIPT|LICENCES)@/g, (mark) => parts[mark]);
}

// The licences go with the script that holds what they are about.
async function live() {
  const style = await Promise.all(['style.css', 'live.css'].map((name) => readFile(here(name), 'utf8')));
  return {
    'live.html': await readFile(here('live.html'), 'utf8'),
    'live.js': `${await bundle('live.mjs')}\n/*\n${(await licences()).replaceAll('*/', '* /')}*/\n`,
    'live.css': style.join('\n'),
  };
}

async function main([folder]) {
  if (!folder) throw new Error('usage: node build.mjs FOLDER');
  const html = await page();
  if (html.split(PLACEHOLDER).length !== 2) throw new Error(`the page must have ${PLACEHOLDER} exactly once`);
  const files = { 'page.html': html, ...await live() };
  await Promise.all(Object.entries(files).map(([name, text]) => writeFile(join(folder, name), text)));
}

main(process.argv.slice(2)).catch((error) => {
  console.error(`build.mjs: ${error.message}`);
  process.exitCode = 1;
});
