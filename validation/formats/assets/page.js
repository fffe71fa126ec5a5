'use strict';
/* Findings by severity and cause, tables that sort and filter, and links that open what hides their target. */

const boxes = [...document.querySelectorAll('.filters input[type=checkbox]')];
const findings = [...document.querySelectorAll('.finding')];
function showFindings() {
  const off = kind => new Set(boxes.filter(b => b.name === kind && !b.checked).map(b => b.value));
  const severities = off('severity'), causes = off('cause');
  let shown = 0;
  for (const f of findings) {
    f.hidden = severities.has(f.dataset.severity) || causes.has(f.dataset.cause);
    shown += !f.hidden;
  }
  document.getElementById('shown').textContent = shown + ' of ' + findings.length + ' findings shown';
}
boxes.forEach(b => b.addEventListener('change', showFindings));
if (boxes.length) showFindings();

const key = cell => cell.dataset.value !== undefined ? cell.dataset.value : cell.textContent.trim();
function order(a, b) {
  const x = parseFloat(a), y = parseFloat(b);
  const numbers = a !== '' && b !== '' && !isNaN(x) && !isNaN(y) && /^[-+.\d]/.test(a) && /^[-+.\d]/.test(b);
  return numbers ? x - y : a.localeCompare(b, 'en', { numeric: true });
}
function sortBy(head) {
  const table = head.closest('table'), column = head.cellIndex;
  const down = head.getAttribute('aria-sort') === 'ascending';
  for (const other of head.parentNode.cells) other.setAttribute('aria-sort', 'none');
  head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
  const rows = [...table.tBodies[0].rows];
  rows.sort((a, b) => (down ? -1 : 1) * order(key(a.cells[column]), key(b.cells[column])));
  table.tBodies[0].append(...rows);
}
document.addEventListener('click', event => {
  const button = event.target.closest && event.target.closest('th button');
  if (button) sortBy(button.closest('th'));
});

function filterRows(input) {
  const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
  const rows = [...document.getElementById(input.dataset.table).tBodies[0].rows];
  let shown = 0;
  for (const row of rows) {
    const text = row.textContent.toLowerCase();
    row.hidden = !words.every(word => text.includes(word));
    shown += !row.hidden;
  }
  input.closest('.tools').querySelector('output').textContent = words.length ? shown + ' of ' + rows.length + ' rows' : '';
}
for (const input of document.querySelectorAll('input[data-table]')) {
  input.disabled = false;
  input.addEventListener('input', () => filterRows(input));
}

function openTarget() {
  let target = null;
  try { target = document.getElementById(decodeURIComponent(location.hash.slice(1))); } catch (error) { return; }
  if (!target) return;
  for (let node = target; node; node = node.parentElement) {
    if (node.tagName === 'DETAILS') node.open = true;
    node.hidden = false;
  }
  if (target.tabIndex < 0) target.tabIndex = -1;
  target.focus({ preventScroll: true });
  target.scrollIntoView({ block: 'center' });
}
addEventListener('hashchange', openTarget);
if (location.hash) openTarget();
let unfolded = [];
addEventListener('beforeprint', () => {
  unfolded = [...document.querySelectorAll('details:not([open])')];
  for (const folded of unfolded) folded.open = true;
});
addEventListener('afterprint', () => { for (const folded of unfolded) folded.open = false; });
