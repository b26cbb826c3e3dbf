// Uses every control of the page that is seen, and tells which of them changed the picture.
(async () => {
  const canvas = document.getElementById('canvas'), gl = canvas.getContext('webgl2');
  const settled = async () => { for (let i = 0; i < 2; i++) await new Promise((done) => requestAnimationFrame(done)); await new Promise((done) => setTimeout(done, 5)); };
  const picture = () => {
    const pixels = new Uint8Array(4 * canvas.width * canvas.height), colors = new Set();
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let print = 0;
    for (let i = 0; i < pixels.length; i += 12) {
      const color = pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2];
      colors.add(color);
      print = (print * 31 + color) >>> 0;
    }
    return { colors: colors.size, print };
  };
  const seen = (control) => control.offsetParent !== null && !control.disabled;
  const changed = {}, used = [];
  const name = (control) => control.id || control.dataset.side || control.dataset.figure || control.textContent;
  const use = async (control, act) => {
    if (!seen(control)) return;
    await act(control);
    await settled();
    used.push(name(control));
    const now = picture().print;
    changed[name(control)] ||= now !== before;
    before = now;
  };
  const set = (control, value) => { control.value = value; control.dispatchEvent(new Event('input', { bubbles: true })); control.dispatchEvent(new Event('change', { bubbles: true })); };
  const first = picture();
  let before = first.print;
  const id = (name) => document.getElementById(name);
  document.querySelectorAll('details').forEach((details) => { details.open = true; });
  await settled();

  for (const name of ['quantity', 'component', 'range']) {
    const held = id(name).value;
    for (const option of [...id(name).options]) await use(id(name), (control) => set(control, option.value));
    set(id(name), held);
    await settled();
    before = picture().print;
  }
  await use(id('least'), (control) => set(control, '0'));
  await use(id('greatest'), (control) => set(control, '1e3'));
  await use(id('greatest'), (control) => set(control, 'nonsense'));
  set(id('range'), 'frame');
  for (const length of ['-1', '0']) await use(id('vector-length'), (control) => set(control, length));
  for (const name of ['bands', 'mesh', 'vectors', 'tools']) for (let i = 0; i < 2; i++) await use(id(name), (control) => control.click());
  for (const value of ['0', '1', id('frame').max]) await use(id('frame'), (control) => set(control, value));
  await use(id('back'), (control) => control.click());
  await use(id('forth'), (control) => control.click());
  await use(id('play'), async (control) => { control.click(); await new Promise((done) => setTimeout(done, 600)); if (control.textContent === 'stop') control.click(); });
  set(id('frame'), id('frame').max);
  for (const value of ['0', '2', 'nonsense', '1']) await use(id('factor'), (control) => set(control, value));
  for (const button of document.querySelectorAll('[data-side]')) await use(button, (control) => control.click());
  for (const axis of ['x', 'y', 'z']) {
    await use(id('clip'), (control) => set(control, axis));
    for (const at of ['0.3', '0.7']) await use(id('clip-at'), (control) => set(control, at));
    for (let i = 0; i < 2; i++) await use(id('clip-flip'), (control) => control.click());
  }
  if (seen(id('clip'))) set(id('clip'), '');
  await settled();
  before = picture().print;
  for (const name of ['nearer', 'farther', 'nearer', 'fit']) await use(id(name), (control) => control.click());
  await use(id('node'), (control) => set(control, '999999999'));
  await use(id('node'), (control) => set(control, '3'));
  const history = !id('picked').hidden && id('node-chart').querySelectorAll('path.curve').length;
  for (const button of document.querySelectorAll('.show')) await use(button, (control) => control.click());
  if (id('to-reason')) await use(id('to-reason'), (control) => control.click());
  await use(id('unpick'), (control) => control.click());
  await use(id('save'), (control) => control.click());
  await use(id('fit'), (control) => control.click());

  let curves = 0;
  for (const name of ['preset', 'abscissa', 'which']) for (const option of [...id(name).options].slice(0, 12)) {
    await use(id(name), (control) => set(control, option.value));
    if (name === 'preset') curves += id('history-chart').querySelectorAll('path.curve').length;
  }
  for (const name of ['log', 'only-cuts']) for (let i = 0; i < 2; i++) await use(id(name), (control) => control.click());
  await use(id('search'), (control) => set(control, 'force'));
  await use(id('none'), (control) => control.click());
  for (const box of [...document.querySelectorAll('#columns input, .legend input')].slice(0, 12)) await use(box, (control) => control.click());
  for (const button of document.querySelectorAll('.chart button')) await use(button, (control) => control.click());
  for (const value of ['dark', 'light', '']) await use(id('theme'), (control) => set(control, value));

  const all = [...document.querySelectorAll('select, input, button')].filter(seen);
  const left = all.filter((control) => !used.includes(name(control)) && !control.closest('#columns, .legend')).map(name);
  const unnamed = all.filter((control) => !(control.closest('label') || control.getAttribute('aria-label') || control.textContent.trim())).map(name);
  return { first, last: picture(), changed, left, unnamed, history, curves, used: used.length };
})()
