// node build.mjs OUT.html
// Bundles script, style and template into one page that needs no network. The
// page still has a placeholder where the simulator puts the report's JSON.

import { readFile, writeFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const PLACEHOLDER = '@VOLCOMP_REPORT_DATA@';
const here = (name) => new URL(name, import.meta.url);

async function bundle() {
  const result = await build({
    entryPoints: [fileURLToPath(here('page.mjs'))], bundle: true, minify: true, write: false,
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
    '@SCRIPT@': await bundle(),
    '@LICENCES@': await licences(),
  };
  const template = await readFile(here('template.html'), 'utf8');
  return template.replace(/@(STYLE|SCRIPT|LICENCES)@/g, (mark) => parts[mark]);
}

async function main([target]) {
  if (!target) throw new Error('usage: node build.mjs OUT.html');
  const html = await page();
  if (html.split(PLACEHOLDER).length !== 2) throw new Error(`the page must have ${PLACEHOLDER} exactly once`);
  await writeFile(target, html);
}

main(process.argv.slice(2)).catch((error) => {
  console.error(`build.mjs: ${error.message}`);
  process.exitCode = 1;
});
