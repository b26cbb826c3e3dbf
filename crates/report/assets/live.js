// Following a run that goes.
const INTERVAL = 1000;

class Live {
  constructor(page) {
    this.page = page;
    this.from = {};
    const ask = (id, path, told) => $(id).addEventListener('click', async () => {
      const answer = await this.request(path, 'POST').catch(() => null);
      this.tell(answer?.ok ? told : 'The run could not be asked; has the server ended?');
    });
    ask('stop', 'stop', 'The run stops after this increment and writes a checkpoint.');
    ask('checkpoint', 'checkpoint', 'A checkpoint is written after this increment.');
    $('frames').addEventListener('click', () => this.frames());
    this.poll();
  }

  tell(text) { $('live-told').textContent = text; }

  request(path, method = 'GET') {
    return fetch(path, { method, headers: { 'X-Asperity-Token': DATA.live.token }, cache: 'no-store' });
  }

  async poll() {
    try {
      const status = await (await this.request('status.json')).json();
      await this.rows(status);
      this.show(status);
      if (!status.runs && this.ran) {
        this.tell('The run has ended; the page is made anew.');
        location.reload();
        return;
      }
      this.ran = status.runs;
    } catch {
      this.tell('The server does not answer; what is here is the last that it said.');
    }
    setTimeout(() => this.poll(), INTERVAL);
  }

  /** Takes the rows that tables have got since. */
  async rows(status) {
    let grown = false;
    for (const name of ['history', 'increments', 'iterations']) {
      const asked = this.from[name] ?? 0;
      const answer = await this.request(`rows?table=${name}&from=${asked}`);
      if (!answer.ok) continue;
      const { table, from, next } = await answer.json();
      if (next === asked) continue;
      const old = DATA[name];
      if (from === 0 || old.header.length !== table.header.length) DATA[name] = table;
      else old.columns.forEach((list, c) => list.push(...table.columns[c]));
      this.from[name] = next;
      grown = true;
      if (name === 'increments') this.log(table);
    }
    if (grown) this.page.curves.refresh();
    $('frames').disabled = !status.frames || status.frames === (this.page.written ?? 0);
  }

  log(table) {
    const box = $('log'), get = (name, i) => column(table, name)[i];
    const lines = column(table, 'increment').map((number, i) => element('div', { class: get('accepted', i) ? null : 'cut' },
      `increment ${number}, time ${shown(get('time', i))}: ${get('accepted', i) ? `${get('iterations', i)} iterations` : `cut: ${get('reason', i) ?? ''}`}`));
    box.append(...lines.slice(-300));
    while (box.children.length > 300) box.firstChild.remove();
    box.scrollTop = box.scrollHeight;
  }

  show(status) {
    const { progress, runs } = status;
    $('stop').disabled = $('checkpoint').disabled = !runs;
    if (!progress) return;
    const long = (seconds) => (seconds >= 3600 ? `${(seconds / 3600).toFixed(1)} h` : seconds >= 90 ? `${(seconds / 60).toFixed(1)} min` : `${seconds.toFixed(0)} s`);
    const lines = [
      ['step', `${progress.step} (${progress.step_number} of ${progress.steps})`],
      ['increment', progress.increment], ['time', `${shown(progress.time)} of ${shown(progress.end_time)}`],
      ['length', shown(progress.dt)], ['iterations of the last attempt', progress.last_iterations], ['cuts', progress.cuts],
      ['running for', long(progress.elapsed)], ['about to go', progress.remaining === null ? '–' : long(progress.remaining)],
      ['largest unbalanced force at', progress.worst_unknown || '–'], ['last cut', progress.last_cut || '–'],
      ['nearest to its limit', progress.worst ? `${progress.worst[0]} ${shown(progress.worst[1].value)} of ${shown(progress.worst[1].limit)}` : '–'],
      ['beyond their limits', progress.beyond.join(', ') || 'none'],
    ];
    $('now').replaceChildren(...lines.map(([name, value]) => element('div', {}, element('dt', {}, name), element('dd', {}, String(value)))));
    $('done').value = progress.end_time > 0 ? progress.time / progress.end_time : 0;
    if (runs) {
      $('standing').textContent = 'running';
      $('standing').className = 'going';
      $('counts').textContent = `${progress.increment} increments, ${progress.cuts} cut, ${progress.iterations} iterations, time ${shown(progress.time)}`;
    }
  }

  async frames() {
    this.tell('Loading.');
    const answer = await this.request('body');
    if (!answer.ok) { this.tell('The frames could not be read.'); return; }
    const { body, blobs } = await answer.json();
    Pack.text = (index) => blobs[index];
    DATA.body = body;
    this.page.written = body?.written ?? 0;
    await this.page.open();
    this.tell(`${this.page.written} frames so far.`);
  }
}
