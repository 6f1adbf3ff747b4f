// node build.mjs PACKAGES OUT: bundles the viewer with the packages of that folder into the one file OUT.
import {mkdirSync, readFileSync, renameSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const [packages, out] = process.argv.slice(2).map((path) => resolve(path));
const source = join(dirname(fileURLToPath(import.meta.url)), 'src');
const esbuild = createRequire(join(packages, 'package.json'))('esbuild');

const {outputFiles: [script]} = esbuild.buildSync({
  entryPoints: [join(source, 'main.js')],
  bundle: true,
  minify: true,
  write: false,
  format: 'iife',
  target: 'es2020',
  nodePaths: [join(packages, 'node_modules')],
  legalComments: 'inline', // the licence of what is bundled goes with it
  charset: 'ascii',
});
if (/<!--|<\/?script/i.test(script.text)) throw new Error('the bundle holds what would end its element in a page');
const style = esbuild.transformSync(readFileSync(join(source, 'page.css'), 'utf8'), {loader: 'css', minify: true}).code.trim();
const page = readFileSync(join(source, 'page.html'), 'utf8')
                 .replace('/*css*/', () => style)
                 .replace('/*js*/', () => script.text.trim());
mkdirSync(dirname(out), {recursive: true});
writeFileSync(`${out}.part`, page);
renameSync(`${out}.part`, out);
console.log(`${out}: ${Math.round(page.length / 1024)} KiB`);
