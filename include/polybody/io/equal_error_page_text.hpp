#pragma once
/// \file
/// Style sheet and script of the page of a comparison at equal error.

#include <string_view>

#include <polybody/math/compiler.hpp>

namespace polybody::detail {

/// Style sheet of the page, without the colours of the formulations.
inline constexpr std::string_view page_style = R"css(
:root { color-scheme: light dark; --page: #f6f7f9; --card: #ffffff; --text: #1b2430; --weak: #5a6676; --rule: #dde2e9;
  --grid: #e4e8ee; --minor: #f0f2f6; --accent: #0b5cad; --bar: #d9e7f5; }
@media (prefers-color-scheme: dark) {
  :root { --page: #12161c; --card: #1a2029; --text: #e6eaf0; --weak: #9aa7b8; --rule: #303a47; --grid: #2d3642;
    --minor: #222a34; --accent: #7fb8f0; --bar: #24405c; }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
body { margin: 0; background: var(--page); color: var(--text);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif; }
body > * { max-width: 1240px; margin: 0 auto; padding: 0 28px; }
header { padding-top: 44px; }
.kind { margin: 0 0 6px; color: var(--weak); font-size: 13px; letter-spacing: .08em; text-transform: uppercase; }
h1 { margin: 0; font-size: 34px; line-height: 1.15; letter-spacing: -.015em; text-wrap: balance;
  overflow-wrap: anywhere; }
h2 { margin: 0 0 6px; font-size: 23px; line-height: 1.25; letter-spacing: -.01em; }
h3 { margin: 0 0 4px; font-size: 16px; line-height: 1.35; }
p { margin: 0 0 12px; max-width: 92ch; overflow-wrap: anywhere; }
.lead { margin: 14px 0 0; font-size: 18px; color: var(--weak); }
.lead b { color: var(--text); font-weight: 600; }
section > p, figcaption p, .card > p { color: var(--weak); font-size: 14.5px; }
figcaption p, .card > p { font-size: 13.5px; line-height: 1.45; }
.card > p b { color: var(--text); font-weight: 600; }
nav { display: flex; flex-wrap: wrap; gap: 6px 20px; margin-top: 18px; padding-top: 14px;
  border-top: 1px solid var(--rule);
  font-size: 14.5px; }
a { color: var(--accent); text-underline-offset: .18em; text-decoration-thickness: 1px; }
nav a { text-decoration: none; }
nav a:hover { text-decoration: underline; }
section { padding-top: 44px; }
.card, .chart { background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 18px 20px;
  margin: 16px 0 0;
  min-width: 0; }
.grid { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 20px; margin-top: 16px; }
.grid { grid-auto-rows: auto auto 1fr; }
.grid > * { margin: 0; grid-row: span 3; }
.grid > .chart { display: grid; grid-template-rows: subgrid; row-gap: 0; }
.stack { display: grid; gap: 20px; align-content: start; min-width: 0; }
.stack > .card { margin: 0; }
.tall .scroll { max-height: 540px; overflow: auto; }
.tall thead th { position: sticky; top: 0; background: var(--card); box-shadow: 0 1px 0 var(--weak); z-index: 2; }

.scroll { overflow-x: auto; margin: 10px -20px 0; padding: 0 20px; background:
  linear-gradient(to right, var(--card) 30%, transparent) 0 0 / 40px 100% local no-repeat,
  linear-gradient(to left, var(--card) 30%, transparent) 100% 0 / 40px 100% local no-repeat,
  linear-gradient(to right, var(--rule), transparent) 0 0 / 12px 100% scroll no-repeat,
  linear-gradient(to left, var(--rule), transparent) 100% 0 / 12px 100% scroll no-repeat; }
.card > .scroll:last-child { margin-bottom: -6px; }
table { border-collapse: collapse; width: 100%; font-size: 14px; font-variant-numeric: tabular-nums lining-nums; }
th, td { padding: 7px 0 7px 14px; text-align: left; vertical-align: baseline; border-bottom: 1px solid var(--rule);
  font-weight: 400; }
.n, thead th { white-space: nowrap; }
th:first-child, td:first-child { padding-left: 0; }
tbody tr:last-child > * { border-bottom: 0; }
tbody th { font-weight: 600; }
thead th { vertical-align: bottom; padding-top: 0; border-bottom-color: var(--weak); }
.n { text-align: right; }
.weak { color: var(--weak); font-style: italic; }
th button { all: unset; box-sizing: border-box; cursor: pointer; color: var(--weak); font-size: 12.5px;
  line-height: 1.3;
  padding: 2px 0; }
th button::after { content: "\2195\FE0E"; opacity: .4; padding-left: .3em; font-size: 11px; }
th[aria-sort] button { color: var(--text); font-weight: 600; }
th[aria-sort="ascending"] button::after { content: "\2191"; opacity: 1; }
th[aria-sort="descending"] button::after { content: "\2193"; opacity: 1; }
th button:hover { color: var(--accent); }
:focus-visible, th button:focus-visible, .legend button:focus-visible { outline: 2px solid var(--accent);
  outline-offset: 2px;
  border-radius: 3px; }
.bar { display: inline-block; min-width: 72px; padding: 1px 6px; border-radius: 3px;
  background: linear-gradient(var(--bar) 0 0) left / var(--share) 100% no-repeat; }
.missing, .remarks { margin: 10px 0 0; padding: 0; list-style: none; font-size: 14px; }
.remarks { margin: 0; }
.missing li, .remarks > li { padding: 3px 0 3px 46px; overflow-wrap: anywhere; }
.missing .swatch, .remarks .swatch { margin-left: -46px; }
.missing b, .remarks b { font-weight: 600; }
summary { cursor: pointer; }
.remarks ul { padding-left: 18px; color: var(--weak); }

.swatch { width: 36px; height: 14px; vertical-align: -1px; margin-right: 9px; flex: none; overflow: visible; }
.formulation { display: inline-flex; align-items: baseline; }
.formulation > span { min-width: 7em; }
.chart > svg { display: block; width: 100%; height: auto; overflow: visible; }
.chart text { font-size: 12.5px; fill: var(--weak); font-variant-numeric: tabular-nums; }
text.name { fill: var(--text); }
text.x { text-anchor: middle; }
text.tick.y { text-anchor: end; }
svg path { fill: none; }
path.grid { stroke: var(--grid); }
path.minor { stroke: var(--minor); }
path.frame { stroke: var(--weak); }
path.line { stroke: currentColor; stroke-width: 2; stroke-linejoin: round; }
path.band { fill: currentColor; fill-opacity: .16; }
path.guide { stroke: var(--weak); stroke-dasharray: 6 4; opacity: .75; }
path.guide[class*=" f"] { stroke: currentColor; stroke-width: 1.6; stroke-dasharray: 1.6 4; opacity: 1; }
path.range { stroke: currentColor; stroke-width: 1.4; }
path.marker { fill: currentColor; stroke: currentColor; stroke-width: 1.4; vector-effect: non-scaling-stroke; }
path.marker.open { fill: var(--card); }
path.pale { opacity: .42; }
path.marker:hover { stroke: var(--text); stroke-width: 2.5; opacity: 1; }
circle.ring { fill: none; stroke: var(--text); stroke-width: 1.1; }
.curve.off, .curve.off * { display: none; }
.legend { display: flex; flex-wrap: wrap; align-content: start; gap: 4px 22px; margin: 12px 0 0; padding: 0;
  list-style: none; font-size: 13.5px;
  line-height: 1.35; }
.chart:not(#work) > .legend { flex-direction: column; }
.legend li { min-width: 0; }
.legend button { all: unset; cursor: pointer; display: flex; align-items: baseline; overflow-wrap: anywhere; }
.legend small { color: var(--weak); font-size: 12.5px; }
.legend button[aria-pressed="false"] { opacity: .4; text-decoration: line-through; }
.legend button:hover span { color: var(--accent); }

iframe { display: block; width: 100%; aspect-ratio: 16 / 10; border: 1px solid var(--rule); border-radius: 8px;
  background: var(--card); margin-bottom: 10px; }
footer { font-size: 13.5px; color: var(--weak); }
footer dl { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 4px 18px; margin: 48px 0 0;
  padding: 20px 0 48px;
  border-top: 1px solid var(--rule); }
footer dt { font-weight: 600; }
footer dd { margin: 0; overflow-wrap: anywhere; }
code { font: 13px/1.5 ui-monospace, SFMono-Regular, Menlo, Consolas, "DejaVu Sans Mono", monospace;
  color: var(--text); }

@media (max-width: 900px) {
  .grid { grid-template-columns: minmax(0, 1fr); grid-auto-rows: auto; }
  .grid > * { grid-row: auto; }
  .grid > .chart { display: block; }
}
@media (max-width: 620px) {
  body > * { padding: 0 16px; }
  header { padding-top: 26px; }
  h1 { font-size: 26px; }
  h2 { font-size: 20px; }
  .lead { font-size: 16px; }
  section { padding-top: 34px; }
  .card, .chart { padding: 14px; border-radius: 8px; }
  .scroll { margin: 8px -14px 0; padding: 0 14px; }
  .chart text { font-size: 20px; }
  path.line { stroke-width: 2.8; }
  .chart > svg path.marker { stroke-width: 2.2; }
  .legend { flex-direction: column; gap: 7px; }
  tbody th { position: sticky; left: 0; background: var(--card);
    box-shadow: -14px 0 0 var(--card), 1px 0 0 var(--rule); z-index: 1;
    padding-right: 10px; }
  tbody th:not(.n), tbody td:not(.n) { min-width: 9.5em; }
  iframe { aspect-ratio: 3 / 4; }
  footer dl { grid-template-columns: minmax(0, 1fr); gap: 0; }
  footer dd { margin-bottom: 8px; }
}
@media print {
  body { background: none; }
  nav, th button::after { display: none; }
  .card, .chart { break-inside: avoid; }
  .scroll { overflow: visible; }
}
)css";

/// Script of the page. A button in the head of a column sorts the rows of the table by this column, unknown numbers
/// last. A button in a legend hides or shows a curve.
inline constexpr std::string_view page_script = R"js(
'use strict';
for (const button of document.querySelectorAll('th button')) {
  button.addEventListener('click', () => {
    const head = button.parentElement, body = head.closest('table').tBodies[0], column = head.cellIndex;
    const sign = head.getAttribute('aria-sort') === 'ascending' ? -1 : 1;
    for (const other of head.parentElement.cells) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
    const value = (row) => {
      const cell = row.cells[column], number = cell.dataset.v;
      return number === undefined ? cell.textContent : number === '' ? NaN : Number(number);
    };
    const order = (a, b) => {
      if (typeof a === 'string') return sign * a.localeCompare(b, 'en', {numeric: true});
      if (isNaN(a) || isNaN(b)) return isNaN(a) - isNaN(b);
      return sign * (a - b);
    };
    body.append(...[...body.rows].sort((a, b) => order(value(a), value(b))));
  });
}
for (const button of document.querySelectorAll('.legend button')) {
  button.addEventListener('click', () => {
    const shown = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', shown);
    const curve = button.closest('figure').querySelector(`.curve[data-curve="${button.dataset.curve}"]`);
    curve.classList.toggle('off', !shown);
  });
}
)js";

}  // namespace polybody::detail
