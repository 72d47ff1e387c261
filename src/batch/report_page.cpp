#include "batch/report_page.h"

namespace domelight {

// clang-format off
const char* const k_report_head = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="referrer" content="no-referrer">
<title>Batch</title>
<style>
:root { color-scheme: light dark; --back: #f4f4f2; --card: #fff; --text: #1c1d20; --quiet: #63666d; --line: #dcdcd8; --accent: #2a5fd0;
        --good: #1d7a46; --bad: #b3261e; --warn: #8a5a00; }
@media (prefers-color-scheme: dark) {
  :root { --back: #131417; --card: #1c1e22; --text: #ececea; --quiet: #9a9da5; --line: #2e3137; --accent: #86aefc; --good: #6fcf97; --bad: #ff8a80; --warn: #f2c063; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--back); color: var(--text); font: 15px/1.45 system-ui, "Segoe UI", Roboto, sans-serif; }
header { padding: 28px clamp(16px, 3vw, 40px) 16px; }
h1 { margin: 0 0 4px; font-size: 24px; font-weight: 650; letter-spacing: -.01em; overflow-wrap: anywhere; }
.quiet { color: var(--quiet); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(132px, 1fr)); gap: 10px; margin: 18px 0 0; }
.tile { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 10px 14px; }
.tile b { display: block; font-size: 21px; font-weight: 620; font-variant-numeric: tabular-nums; }
.tile span { color: var(--quiet); font-size: 13px; }
.bar { position: sticky; top: 0; z-index: 2; display: flex; flex-wrap: wrap; gap: 8px; align-items: center; padding: 10px clamp(16px, 3vw, 40px);
       background: color-mix(in srgb, var(--back) 88%, transparent); backdrop-filter: blur(10px); border-bottom: 1px solid var(--line); }
.bar input[type=search] { flex: 1 1 180px; min-width: 0; }
.bar input, .bar select, .bar button { font: inherit; color: inherit; background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 6px 10px; min-height: 36px; }
.bar button { cursor: pointer; }
.bar button[aria-pressed=true] { border-color: var(--accent); color: var(--accent); }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
main { padding: 16px clamp(16px, 3vw, 40px) 60px; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(300px, 100%), 1fr)); gap: 14px; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 12px; overflow: hidden; display: flex; flex-direction: column; content-visibility: auto;
        contain-intrinsic-size: auto 360px; }
.shot { display: block; position: relative; overflow: hidden; width: 100%; border: 0; padding: 0; background: #16181c; cursor: zoom-in; aspect-ratio: 1600 / 1130; }
.shot img { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: contain; }
.none { display: grid; place-items: center; aspect-ratio: 1600 / 1130; color: var(--quiet); background: color-mix(in srgb, var(--line) 40%, transparent); font-size: 13px; }
.body { padding: 10px 14px 14px; display: flex; flex-direction: column; gap: 6px; flex: 1; }
.name { font-weight: 600; overflow-wrap: anywhere; }
.name a { color: inherit; text-decoration: none; }
.name a:hover { text-decoration: underline; }
dl { display: grid; grid-template-columns: auto 1fr auto 1fr; gap: 1px 10px; margin: 0; font-size: 13px; font-variant-numeric: tabular-nums; }
dt { color: var(--quiet); } dd { margin: 0; }
.mark { display: inline-block; border-radius: 999px; padding: 1px 9px; font-size: 12px; font-weight: 600; border: 1px solid currentColor; }
.done { color: var(--good); } .failed, .missing { color: var(--bad); } .warned { color: var(--warn); }
.why { font-size: 13px; overflow-wrap: anywhere; white-space: pre-line; }
details { font-size: 13px; } summary { cursor: pointer; color: var(--warn); } details li { overflow-wrap: anywhere; } details ul { margin: 4px 0 0; padding-left: 18px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; font-variant-numeric: tabular-nums; background: var(--card); border: 1px solid var(--line); }
th, td { text-align: right; padding: 6px 10px; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:nth-child(-n+3), td:nth-child(-n+3) { text-align: left; }
th button { all: unset; cursor: pointer; font-weight: 600; } th button:focus-visible { outline: 2px solid var(--accent); }
td a { color: var(--accent); }
td img { display: block; height: 44px; width: 62px; object-fit: cover; border-radius: 4px; background: #16181c; }
dialog { border: 0; padding: 0; background: #16181c; max-width: 96vw; max-height: 96vh; border-radius: 10px; }
dialog img { display: block; max-width: 96vw; max-height: 92vh; } dialog::backdrop { background: rgb(0 0 0 / .75); }
@media (max-width: 520px) { header { padding-top: 18px; } h1 { font-size: 20px; } .tiles { grid-template-columns: 1fr 1fr; } .bar select { flex: 1 1 auto; } }
</style>
</head>
<body>
<header><h1 id="title"></h1><div class="quiet" id="under"></div><div class="tiles" id="tiles"></div></header>
<div class="bar" role="toolbar" aria-label="What is shown">
<input type="search" id="find" placeholder="Find by name" aria-label="Find by name">
<select id="sort" aria-label="Sort by"></select>
<button id="turn" aria-label="Turn the order round">↓</button>
<select id="only" aria-label="Which jobs"></select>
<button id="form" aria-pressed="false">Table</button>
<span class="quiet" id="shown" role="status"></span>
</div>
<main id="main"></main>
<dialog id="large" aria-label="Picture"><img id="picture" alt=""></dialog>
<noscript><p style="padding:20px">This page lists its jobs with JavaScript.</p></noscript>
<script type="application/json" id="data">)html";

const char* const k_report_tail = R"html(</script>
<script>
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const make = (tag, options = {}, ...inner) => {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(options)) key in node ? (node[key] = value) : node.setAttribute(key, value);
  node.append(...inner);
  return node;
};
const number = (value, digits) => value.toLocaleString("en", { maximumFractionDigits: digits });
const seconds = (s) => s == null ? "–" : s < 100 ? `${number(s, s < 10 ? 2 : 1)} s` : s < 5400 ? `${number(s / 60, 1)} min` : `${number(s / 3600, 1)} h`;
const bytes = (b) => b == null ? "–" : b < 1e6 ? `${number(b / 1e3, 1)} kB` : b < 1e9 ? `${number(b / 1e6, 1)} MB` : `${number(b / 1e9, 2)} GB`;
const error = (e) => e == null ? "–" : e === 0 ? "0" : e < 0.01 ? e.toExponential(1) : `${number(100 * e, 1)} %`;
const count = (n) => n == null ? "–" : number(n, 0);

// name, its field, how it is written
const fields = [["name", "output", String], ["time", "seconds", seconds], ["CPU time", "cpu", seconds], ["size", "bytes", bytes], ["error", "error", error],
                ["repairs", "repaired", count], ["memory", "memory", bytes], ["attempts", "attempts", count]];
const states = [["all", () => true], ["done", (j) => j.status === "done"], ["not done", (j) => j.status !== "done"], ["with warnings", (j) => j.warnings.length > 0],
                ["repaired", (j) => j.repaired > 0], ["tried again", (j) => j.attempts > 1]];
let form = "cards", up = true;

function total(key) { return data.jobs.reduce((sum, job) => sum + (job[key] ?? 0), 0); }
function head() {
  $("title").textContent = data.title;
  document.title = `Batch: ${data.title}`;
  $("under").textContent = `domelight ${data.version} · ${count(data.jobs.length)} jobs · sources in ${data.root}`;
  const done = data.jobs.filter((job) => job.status === "done").length, warned = data.jobs.filter((job) => job.warnings.length).length;
  for (const [value, words, mark] of [[`${count(done)} of ${count(data.jobs.length)}`, "done", done === data.jobs.length ? "done" : "failed"],
                                      [count(data.jobs.length - done), "not done", done < data.jobs.length ? "failed" : ""],
                                      [seconds(total("cpu")), "CPU time"], [seconds(total("estimate")), "estimated before"], [bytes(total("bytes")), "results"],
                                      [count(total("repaired")), "texels repaired"], [count(warned), "jobs with warnings", warned ? "warned" : ""]])
    $("tiles").append(make("div", { className: "tile" }, make("b", { className: mark ?? "", textContent: value }), make("span", { textContent: words })));
  for (const [name] of fields) $("sort").append(make("option", { value: name, textContent: `Sort by ${name}` }));
  for (const [name, test] of states) $("only").append(make("option", { value: name, textContent: `${name[0].toUpperCase()}${name.slice(1)} (${count(data.jobs.filter(test).length)})` }));
}

function mark(job) { return make("span", { className: `mark ${job.status}`, textContent: job.status }); }
function enlarge(job) {
  $("picture").src = job.picture ?? job.thumb;
  $("picture").alt = `Preview of ${job.output}`;
  $("large").showModal();
}
function image(job) { return make("img", { src: job.thumb, alt: `Preview of ${job.output}`, loading: "lazy", decoding: "async" }); }
function link(job) { return job.folder ? make("a", { href: job.folder, textContent: job.output }) : job.output; }
function card(job) {
  const shot = job.thumb ? make("button", { className: "shot", title: "Enlarge", onclick: () => enlarge(job) }, image(job))
                         : make("div", { className: "none", textContent: job.status === "done" ? "no picture" : job.status });
  const list = make("dl");
  for (const [name, key, write] of fields.slice(1)) if (name !== "attempts" || job.attempts > 1) list.append(make("dt", { textContent: name }), make("dd", { textContent: write(job[key]), title: key === "error" ? job.error_of ?? "" : "" }));
  const body = make("div", { className: "body" }, make("div", { className: "name" }, link(job)), make("div", {}, mark(job), make("span", { className: "quiet", textContent: `  ${job.kind}${job.host ? ` on ${job.host}` : ""}` })), list);
  if (job.reason) body.append(make("div", { className: `why ${job.status === "done" ? "warned" : "failed"}`, textContent: job.status === "done" ? `an earlier attempt: ${job.reason}` : job.reason }));
  if (job.warnings.length) {
    const lines = make("ul");
    for (const line of job.warnings) lines.append(make("li", { textContent: line }));
    body.append(make("details", {}, make("summary", { textContent: job.warnings.length === 1 ? "1 warning" : `${job.warnings.length} warnings` }), lines));
  }
  return make("article", { className: "card" }, shot, body);
}
function table(jobs) {
  const titles = make("tr", {}, make("th"), ...fields.slice(0, 1).map(column), make("th", { textContent: "status" }), ...fields.slice(1).map(column));
  const rows = jobs.map((job) => make("tr", {}, make("td", {}, job.thumb ? image(job) : ""), make("td", {}, link(job)), make("td", {}, mark(job)),
                                      ...fields.slice(1).map(([, key, write]) => make("td", { textContent: write(job[key]) }))));
  return make("div", { className: "scroll" }, make("table", {}, make("thead", {}, titles), make("tbody", {}, ...rows)));
}
function column([name]) {
  const now = $("sort").value === name;
  return make("th", { "aria-sort": now ? (up ? "ascending" : "descending") : "none" },
              make("button", { textContent: name + (now ? (up ? " ↑" : " ↓") : ""), onclick: () => { up = now ? !up : name === "name"; $("sort").value = name; show(); } }));
}
function show() {
  const key = fields.find(([name]) => name === $("sort").value)[1], words = $("find").value.toLowerCase().split(/\s+/), test = states.find(([name]) => name === $("only").value)[1];
  const jobs = data.jobs.filter((job) => test(job) && words.every((word) => job.output.toLowerCase().includes(word)));
  // What has no value comes last either way.
  jobs.sort((a, b) => (a[key] == null) - (b[key] == null) || (up ? 1 : -1) * (typeof a[key] === "string" ? a[key].localeCompare(b[key], "en", { numeric: true }) : a[key] - b[key]));
  $("turn").textContent = up ? "↑" : "↓";
  $("shown").textContent = jobs.length === data.jobs.length ? "" : `${count(jobs.length)} shown`;
  $("form").setAttribute("aria-pressed", form === "table");
  $("main").replaceChildren(form === "table" ? table(jobs) : make("div", { className: "cards" }, ...jobs.map(card)));
}
head();
$("sort").onchange = () => { up = $("sort").value === "name"; show(); };
$("turn").onclick = () => { up = !up; show(); };
$("find").oninput = $("only").onchange = show;
$("form").onclick = () => { form = form === "table" ? "cards" : "table"; show(); };
$("large").onclick = () => $("large").close();
show();
</script>
</body>
</html>
)html";
// clang-format on

}  // namespace domelight
