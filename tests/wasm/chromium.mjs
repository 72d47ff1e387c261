// The browser and the packages that pages are tested with, and why a test may have to do without them.
import {spawnSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

export const {DOMELIGHT_ROOT: root} = process.env;
export const app = path.dirname(import.meta.dirname), modules = path.join(app, 'node_modules');
export const chromium = spawnSync('sh', ['-c', 'command -v chromium'], {encoding: 'utf8'}).stdout?.trim();

/// `name`: the package that the test needs besides.
export const withoutBrowser = name => (!root || !chromium ? 'there is no Chromium' : !fs.existsSync(path.join(modules, name)) ? `${name} is not installed` : false);
