"""What every HTML report shares: its style, light and dark, and the few lines that filter findings."""

from __future__ import annotations

STYLE = """
:root { color-scheme: light dark; --back: #f8f9fb; --card: #ffffff; --ink: #20242c; --faint: #646b78; --line: #dfe3ea;
  --error: #c1121f; --warning: #a65f00; --note: #2b62b8; --pass: #1c7a3e; --mark: #eef1f6; }
@media (prefers-color-scheme: dark) { :root { --back: #14161a; --card: #1d2026; --ink: #e6e8ec; --faint: #9aa2b1;
  --line: #343a45; --error: #ff7b7b; --warning: #f0b04a; --note: #85b4ff; --pass: #62cf8a; --mark: #282c35; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 70rem; padding: 1rem; background: var(--back); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.2rem; margin: 2.2rem 0 .4rem; }
h3 { font-size: 1rem; margin: 1.4rem 0 .5rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .9rem; background: var(--card); }
th, td { padding: .3rem .7rem; border: 1px solid var(--line); text-align: left; vertical-align: top; }
th { background: var(--mark); } td.number { text-align: right; font-variant-numeric: tabular-nums; }
.verdict { display: inline-block; padding: 0 .6rem; border-radius: .4rem; color: var(--card); font-weight: 600; }
.fail, .unusable { background: var(--error); } .warn { background: var(--warning); } .pass { background: var(--pass); }
.faint { color: var(--faint); } .picture { max-width: 100%; border-radius: .6rem; }
.finding { background: var(--card); border: 1px solid var(--line); border-left: .35rem solid var(--line);
  border-radius: .4rem; padding: .5rem .8rem; margin: .6rem 0; }
.finding[hidden] { display: none; } .finding p { margin: .25rem 0; }
.error { border-left-color: var(--error); } .warning { border-left-color: var(--warning); }
.note { border-left-color: var(--note); } .suppressed { opacity: .65; }
.filters { position: sticky; top: 0; background: var(--back); padding: .5rem 0; border-bottom: 1px solid var(--line); }
.filters label { margin-right: .9rem; white-space: nowrap; }
details { margin: .8rem 0; } summary { cursor: pointer; } pre { overflow-x: auto; font-size: .85rem; }
@media (max-width: 40rem) { body { padding: .6rem; font-size: 15px; } th, td { padding: .25rem .4rem; } }
@media print { .filters { display: none; } .finding { break-inside: avoid; } }
"""

SCRIPT = """
const boxes = [...document.querySelectorAll('.filters input')];
const findings = [...document.querySelectorAll('.finding')];
function show() {
  const off = kind => new Set(boxes.filter(b => b.name === kind && !b.checked).map(b => b.value));
  const severities = off('severity'), blames = off('blame');
  let shown = 0;
  for (const f of findings) {
    f.hidden = severities.has(f.dataset.severity) || blames.has(f.dataset.blame);
    shown += !f.hidden;
  }
  document.getElementById('shown').textContent = shown + ' of ' + findings.length + ' findings shown';
}
boxes.forEach(b => b.addEventListener('change', show));
if (boxes.length) show();
"""
