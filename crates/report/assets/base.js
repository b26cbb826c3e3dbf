// What all parts of the page use.
const $ = (id) => document.getElementById(id);
const DATA = JSON.parse($('data').textContent);

/** An element with attributes and children; texts stay texts. */
function element(tag, attributes = {}, ...children) {
  const made = tag === 'svg' || element.svg.has(tag)
    ? document.createElementNS('http://www.w3.org/2000/svg', tag)
    : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined && value !== false) made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children);
  return made;
}
element.svg = new Set(['g', 'path', 'line', 'rect', 'circle', 'text', 'clipPath', 'defs']);

/** A number with five digits. */
function shown(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  const text = size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(5))) : value.toExponential(4).replace(/\.?0+e/, 'e');
  return text.replace('-', '−');
}

/** A number that was typed; nothing where it is none. */
function typed(text) {
  const value = Number(text.trim().replace('−', '-').replace(',', '.'));
  return text.trim() !== '' && Number.isFinite(value) ? value : null;
}

/** Round steps of an axis between two values: about `count` of them. */
function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const raw = (high - low) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((x) => x * power).find((x) => x >= raw * 0.999) || 10 * power;
  const out = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step && out.length < 100; i++) out.push(i * step);
  return out;
}

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/** Calls once for many changes in one picture of the screen. */
function gathered(call) {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; call(); });
  };
}

/** Listeners of a change of colours. */
const onColors = [];
function setTheme(name) {
  if (name) document.documentElement.dataset.theme = name;
  else delete document.documentElement.dataset.theme;
  onColors.forEach((call) => call());
}
const styleColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
