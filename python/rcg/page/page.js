'use strict';
// The page: forms from the option tables, runs on the server, views of their results. The rc-* tools do all work.

const $ = id => document.getElementById(id);
const TITLES = {import: 'Read the file', pick: 'Crop, resample, turn', detrend: 'Level and filter', solve: 'Press', stress: 'Stresses below',
  slip: 'Friction', wear: 'Wear', heat: 'Flash temperatures', fatigue: 'Fatigue', deflect: 'Displacement', leak: 'Leakage'};
// The options that a new step begins with.
const FIRST = {
  'rc-detrend': [['poly', '2'], ['outliers', '5'], ['fill', true]],
  'rc-solve': [['load', '60N'], ['radius', '3.75mm'], ['estar', '114GPa'], ['hardness', '6GPa']],
  'rc-stress': [['nu', '0.28'], ['section', 'y=0'], ['depths', '0:40um:41']],
  'rc-slip': [['mu', '0.3'], ['nu', '0.28'], ['tangential', '']],
  'rc-wear': [['coefficient', ''], ['distance', '']],
  'rc-heat': [['mu', '0.3'], ['speed', ''], ['conductivity', ''], ['diffusivity', '']],
  'rc-fatigue': [['bending-limit', ''], ['torsion-limit', ''], ['nu', '0.28'], ['pass', 'x'], ['depths', 'auto']],
  'rc-leak': [['viscosity', ''], ['pressure-drop', '']],
};
// Views: their first option, and what its parts mean. [least, most, step] is a slider; words are a choice.
const VIEWS = {
  Map: {},
  Figure: {options: []},
  Relief: {options: [['view', '30,40']], mark: ',', parts: () => ({Turn: [-180, 180, 5], Tilt: [5, 90, 5]})},
  Profile: {options: [['cut', 'y=0']], mark: '=', parts: f => ({'Line of constant': ['y', 'x'],
    Place: [-f.nx * f.dx / 2, f.nx * f.dx / 2, f.dx]})},
  Distribution: {options: [['histogram', true]]},
  Curves: {options: [['curve', 'load:contact_area']], mark: ':', report: true,
    parts: (f, names) => ({Horizontal: names, Vertical: names})},
  Numbers: {options: [], report: true, tool: 'rc-info'},
};
const look = {keep: '', colormap: '', range: ''};
let tables, most, file = null, steps = [], runs = [], run = null, seen = '', frames = [], frame = null, view = 'Map', shows = 0, ids = 0;

function make(tag, more = {}, ...inside) {
  const element = Object.assign(document.createElement(tag), more);
  for (const name of Object.keys(more)) if (name.includes('-')) element.setAttribute(name, more[name]);
  element.append(...inside);
  return element;
}
const button = (textContent, onclick, more) => make('button', {type: 'button', textContent, onclick, ...more});
const address = (at, query) => at + '?' + new URLSearchParams(query);
async function ask(at, query, body) {
  const answer = await fetch(address(at, query), body === undefined ? {} : {method: 'POST', body});
  if (!answer.ok) throw new Error(await answer.text());
  return answer;
}
function tell(text, className = '') { Object.assign($('said'), {textContent: text, className}); }
const trying = act => async (...given) => { try { await act(...given); } catch (e) { tell(e.message, 'failed'); } };
function command(text) {
  const copy = button('Copy', async () => { await navigator.clipboard.writeText(text + '\n'); copy.textContent = 'Copied'; });
  return make('div', {className: 'command'}, make('code', {textContent: text}), copy);
}
function choice(label, words, value, onchange) {
  const select = make('select', {}, ...words.map(word => new Option(...[word].flat())));
  select.value = value;
  select.onchange = () => onchange(select.value);
  return make('label', {}, label + ' ', select);
}

// ---- forms: a row for each option of a command ----

const isFlag = row => row.argument === null && !row.words.length;
const given = options => options.filter(([, value]) => value !== '' && value !== false);
// changed() follows a new value, redo() another order or number of the options [[name, value], ...].
function form(tool, options, changed, redo) {
  const rows = Object.fromEntries(tables[tool].options.map(row => [row.name, row]));
  const box = make('div', {}, ...options.map((option, k) => formRow(rows[option[0]], option, k, options, changed, redo)));
  const free = tables[tool].options.filter(row => row.repeats || !options.some(option => option[0] === row.name));
  box.append(choice('', [['Add an option …', ''], ...free.map(row => [`${row.name}: ${row.help.slice(0, 70)}`, row.name])], '', name => {
    options.push([name, isFlag(rows[name]) ? true : '']);
    redo();
  }));
  box.lastChild.lastChild.setAttribute('aria-label', 'Add an option of ' + tool);
  return box;
}
function formRow(row, option, k, options, changed, redo) {
  const id = 'field' + ++ids, chosen = row.only_words && row.type === 'choice', kind = isFlag(row) ? 'checked' : 'value';
  const field = chosen ? make('select', {id}, ...row.words.map(word => new Option(word)))
    : make('input', {id, ...(isFlag(row) ? {type: 'checkbox'} : {spellcheck: false, autocomplete: 'off', placeholder: row.argument ?? ''})});
  if (chosen && option[1] === '') option[1] = row.words[0];
  field[kind] = option[1];
  field.oninput = () => { option[1] = field[kind]; changed(); };
  const up = () => { options.splice(k - 1, 0, ...options.splice(k, 1)); redo(); }, drop = () => { options.splice(k, 1); redo(); };
  const units = row.units.length ? ` Units: ${row.units.join(', ')}; without a unit it is ${row.unit}.` : '';
  return make('div', {className: 'option'}, make('label', {htmlFor: id, textContent: row.name}), field, make('span', {},
    ...(row.type === 'step' && k > 0 ? [button('↑', up, {'aria-label': `Do ${row.name} earlier`})] : []),
    button('✕', drop, {'aria-label': 'Remove ' + row.name})),
  make('p', {className: 'hint', textContent: row.help.replace('%s', row.words.join(', ')) + '.' + units}));
}

// ---- steps ----

// Steps that do something; each after the last contact reads that contact, unless it changes the surface.
const used = () => steps.filter((step, k) => k === 0 || step.tool !== 'rc-pick' || given(step.options).length);
const asked = all => all.map((step, k) => {
  const contact = all.slice(0, k).map(other => other.tool).lastIndexOf('rc-solve') + 1;
  return {tool: step.tool, options: given(step.options), from: /pick|detrend|solve/.test(step.tool) ? k : contact || k};
});
function add(tool, at) { steps.splice(at, 0, {tool, options: (FIRST[tool] ?? []).map(option => [...option]), open: true}); }
function begin(chosen) {
  file = chosen;
  if (!steps.length) ['rc-import', 'rc-pick', 'rc-detrend', 'rc-solve', 'rc-stress'].forEach(add);
  steps = steps.filter(step => step.tool !== 'rc-import');
  if (!file.stream) add('rc-import', 0);
  else if (steps[0]?.tool !== 'rc-pick') add('rc-pick', 0);
  if (file.stream && !steps[0].options.length) steps[0].options.push(['set', 'stream=' + file.name]); // rc-pick wants something to do
  for (const step of steps) step.open = /detrend|solve/.test(step.tool);
  drawSteps();
  start(1);
}
function drawSteps() {
  $('source').textContent = `${file.name}, ${file.size < 1e6 ? Math.ceil(file.size / 1e3) + ' kB' : Math.ceil(file.size / 1e6) + ' MB'}`;
  $('go').disabled = $('add').disabled = false;
  const buttons = k => [
    ...(k > 1 ? [button('Do earlier', () => { steps.splice(k - 1, 0, ...steps.splice(k, 1)); drawSteps(); })] : []),
    ...(k > 0 ? [button('Remove', () => { steps.splice(k, 1); drawSteps(); })] : [])];
  $('steps').replaceChildren(...steps.map((step, k) => {
    Object.assign(step, {line: make('div'), state: make('span', {className: 'state'}), shown: ''});
    step.card = make('details', {open: step.open}, make('summary', {}, make('h2', {textContent: TITLES[step.tool.slice(3)] ?? step.tool}),
      make('code', {textContent: step.tool}), step.state), make('p', {className: 'hint', textContent: tables[step.tool].summary + '.'}),
    form(step.tool, step.options, changed, drawSteps), step.line, make('div', {className: 'row'}, ...buttons(k)));
    step.card.ontoggle = () => { step.open = step.card.open; };
    return step.card;
  }));
  changed();
}
function changed() {
  sessionStorage.setItem('work', JSON.stringify({file, steps: steps.map(({tool, options, open}) => ({tool, options, open}))}));
  clearTimeout(changed.later);
  changed.later = setTimeout(trying(async () => {
    const all = used(), {commands} = await (await ask('steps', {}, JSON.stringify({file: file.id, steps: asked(all), start: false}))).json();
    for (const step of steps) step.command = commands[all.indexOf(step)];
    states();
  }), 150);
}
// The state of each step, if the selected run has the same command.
const STATES = {running: 'running', short: 'accuracy not reached', failed: 'failed', stopped: 'cancelled'};
function states() {
  for (const step of steps) {
    const found = run?.steps.find(other => other.command === step.command), words = found?.words ?? '', key = step.command + words;
    step.card.dataset.state = found?.state ?? '';
    step.state.textContent = !step.command ? 'not used' : found?.state === 'done' ? `done, ${found.seconds.toFixed(1)} s` : STATES[found?.state] ?? '';
    if (step.shown === key) continue; // a selection of the text stays
    step.shown = key;
    step.line.replaceChildren(...(step.command ? [command(step.command)] : []), make('p', {className: 'said', textContent: words}));
  }
}
const start = trying(async count => {
  tell('Starting …');
  const {run: number} = await (await ask('steps', {}, JSON.stringify({file: file.id, steps: asked(used().slice(0, count)), start: true}))).json();
  select(number);
});

// ---- runs ----

const WORDS = {waiting: 'Waiting for other runs …', done: 'Done.', stopped: 'Cancelled.',
  short: 'Done, but a tool stopped short of the requested accuracy: see its message.'};
const active = one => one?.state === 'running' || one?.state === 'waiting';
function select(number) {
  run = runs.find(other => other.number === number) ?? {number, state: 'waiting', steps: []};
  seen = '';
  news();
}
function news() {
  run = runs.find(other => other.number === run?.number) ?? (active(run) ? run : runs.at(-1) ?? null);
  $('runs').replaceChildren(...runs.flatMap(({number, state}) => [
    button(`Run ${number}: ${state}`, () => select(number), {'aria-pressed': number === run.number}),
    button('✕', trying(() => ask('remove', {run: number}, '')), {'aria-label': 'Cancel or remove run ' + number})]));
  states();
  if (!run) return;
  const now = run.steps.find(step => step.state === 'running'), failed = run.steps.find(step => step.state === 'failed');
  const well = run.steps.filter(step => /done|short/.test(step.state)).length;
  $('cancel').disabled = !active(run);
  $('progress').value = (well + (now?.progress ?? 0)) / (run.steps.length || 1);
  document.body.dataset.run = `${run.number} ${run.state}`;
  if (seen === document.body.dataset.run && !now) return;
  seen = document.body.dataset.run;
  tell(now ? `${now.tool}: ${now.doing || 'running'}` : failed ? failed.words : WORDS[run.state], failed ? 'failed' : '');
  if (!active(run)) collect();
}
// The frames of all steps of the selected run.
const collect = trying(async () => {
  const {number} = run, found = [];
  for (const [k, step] of run.steps.entries()) {
    if (!/done|short/.test(step.state)) continue;
    for (const [n, f] of (await (await ask('frames', {run: number, step: k})).json()).entries())
      found.push({dunit: 'm', ...f, nx: +f.nx, ny: +f.ny, dx: +f.dx, dy: +f.dy, step: k, n, key: `${k} ${f.channel}`});
  }
  if (run?.number !== number) return;
  frames = found;
  $('result').hidden = !frames.length;
  const keys = new Map(frames.map(f => [f.key, f])), last = [...keys.keys()].reverse(), kept = $('channel').dataset.kept;
  $('channel').replaceChildren(...[...keys.values()].map(f => new Option(`${f.channel}, after ${run.steps[f.step].tool}`, f.key)));
  $('channel').value = keys.has(kept) ? kept : last.find(key => key.endsWith(' pressure')) ?? last.find(key => key.endsWith(' height')) ?? last[0];
  if (frames.length) channels();
});
function channels() {
  const some = frames.filter(f => f.key === $('channel').value), old = $('which').selectedIndex;
  const name = f => [f.case && `case ${f.case}`, f.load && `load ${shown(+f.load, 'N')}`, f.depth && `depth ${shown(+f.depth, 'm')}`].filter(Boolean).join(', ');
  $('which').replaceChildren(...some.map(f => new Option(name(f), f.n)));
  $('which').selectedIndex = Math.min(Math.max(old, 0), some.length - 1);
  $('which').parentNode.hidden = some.length < 2;
  show();
}

// ---- views ----

const map = new MapView($('map'), text => { $('at').textContent = text; });
const show = trying(async () => {
  const turn = ++shows, kind = VIEWS[view];
  frame = frames.find(f => f.key === $('channel').value && f.n === +$('which').value);
  $('map').hidden = view !== 'Map';
  $('picture').hidden = view === 'Map' || view === 'Numbers';
  $('numbers').hidden = view !== 'Numbers';
  $('stage').classList.add('busy');
  downloads();
  try {
    const report = kind.report && run.steps[frame.step].report;
    const table = report ? (await (await ask('file', {...place(), of: 'report'})).text()).trim().split('\n').map(line => line.split('\t')) : [[]];
    await (view === 'Map' ? showMap : showMade)(frame, kind, table, () => turn === shows);
    if (turn === shows) document.body.dataset.shown = `${run.number} ${view} ${frame.channel}`;
  } finally {
    if (turn === shows) $('stage').classList.remove('busy');
  }
});
const place = () => ({run: run.number, step: frame.step});
async function showMap(f, kind, table, valid) {
  mapDials(f);
  if (f.nx * f.ny > 1 << 25) throw new Error(`The map has ${f.nx} × ${f.ny} nodes, and the page draws at most 33 million: choose Figure, or resample it in the step Crop.`);
  const bytes = await (await ask('values', {...place(), frame: f.n})).arrayBuffer(), {channel, unit} = f;
  if (!valid()) return;
  const keep = look.keep || (channel === 'gap' ? 'smallest' : /height|displacement/.test(channel) ? 'mean' : 'largest');
  await map.show({...f, values: f.type === 'f32' ? new Float32Array(bytes) : new Float64Array(bytes)}, keep, look.range, async (low, high) => {
    const picture = await createImageBitmap(await (await ask('colours', {channel, unit, low, high, colormap: look.colormap})).blob());
    const g = make('canvas', {width: 257, height: 1}).getContext('2d');
    g.drawImage(picture, 0, 0);
    return new Uint32Array(g.getImageData(0, 0, 257, 1).data.buffer);
  });
  $('at').textContent = `${f.nx} × ${f.ny} nodes, ${shown(map.low, unit)} to ${shown(map.high, unit)}. Wheel or + and − zoom, drag or arrow keys move, 0 shows all.`;
  $('map').setAttribute('aria-label', `Map of ${channel}: ${$('at').textContent}`);
}
function mapDials(f) {
  const set = name => value => { look[name] = value; show(); }, colormaps = tables['rc-render'].options.find(row => row.name === 'colormap').words;
  $('look').replaceChildren();
  $('dials').replaceChildren(button('All', () => map.fit()), button('+', () => map.zoom(1.5), {'aria-label': 'Zoom in'}),
    button('−', () => map.zoom(1 / 1.5), {'aria-label': 'Zoom out'}),
    choice('A pixel shows', [['automatic', ''], 'largest', 'mean', 'smallest'], look.keep, set('keep')),
    choice('Colours', [['automatic', ''], ...colormaps], look.colormap, set('colormap')),
    choice('Range', [['all values', ''], '0.5 % to 99.5 %'], look.range, set('range')),
    button('Crop to this part', () => {
      const [c, r, d, s] = map.part();
      if (!steps.some(step => step.tool === 'rc-pick')) add('rc-pick', 1);
      const crop = steps.find(step => step.tool === 'rc-pick');
      crop.options = [...crop.options.filter(([name]) => name !== 'crop'), ['crop', `${c},${r},${d - c + 1},${s - r + 1}`]];
      crop.open = true;
      drawSteps();
      tell('The step “Crop” has this part of the map now. Run the steps to use it.');
    }),
    button('Figure of this part', () => {
      const [c, r, d, s] = map.part(), text = v => +v.toPrecision(7), [[x, y], [u, v]] = [map.at(c - 0.2, r - 0.2), map.at(d + 0.2, s + 0.2)];
      VIEWS.Figure.options = [['window', `${text(x)}:${text(u)},${text(y)}:${text(v)}`]];
      $('views').querySelector('[value=Figure]').click();
    }));
}
// The frame and the view as options of rc-render.
function framed(options) {
  const more = {channel: frame.channel, case: frame.case, depth: frame.depth}, has = name => options.some(option => option[0] === name);
  return [...Object.entries(has('curve') ? {} : more).filter(([name, value]) => value && !has(name)), ...given(options)];
}
const query = (tool, options, name) => ({...place(), tool, options: JSON.stringify(options), name});
async function showMade(f, kind, table, valid) {
  const tool = kind.tool ?? 'rc-render', redo = () => { clearTimeout(show.later); show.later = setTimeout(show, 300); };
  const words = kind.tool ? [...(f.channel === 'height' ? [['areal', true]] : []), ...given(kind.options)] : framed(kind.options);
  if (!valid()) return;
  if (!$('dials').contains(document.activeElement)) $('dials').replaceChildren(...viewDials(f, kind, table, redo));
  if (!$('look').contains(document.activeElement)) $('look').replaceChildren(make('div'), form(tool, kind.options, redo, () => { document.activeElement.blur(); show(); }));
  const answer = await ask('made', query(tool, words, kind.tool ? 'numbers.txt' : 'figure.png')), blob = await answer.blob(), text = kind.tool && await blob.text();
  if (!valid()) return;
  $('look').firstChild.replaceWith(command(decodeURIComponent(answer.headers.get('X-Command'))));
  $('at').textContent = decodeURIComponent(answer.headers.get('X-Words'));
  if (kind.tool) return showNumbers(table, text);
  URL.revokeObjectURL($('picture').src);
  Object.assign($('picture'), {src: URL.createObjectURL(blob), alt: `${view} of ${f.channel}`});
}
// Sliders and choices for the parts of the first option.
function viewDials(f, kind, table, redo) {
  const option = kind.options.find(([, value]) => kind.mark && String(value).includes(kind.mark));
  if (!option) return [];
  const names = table[0].map(head => head.split('/')[0]).filter((_, k) => table.slice(1).some(row => row[k] !== '' && !isNaN(row[k])));
  return Object.entries(kind.parts(f, names)).map(([label, values], k) => {
    const set = value => { option[1] = option[1].split(kind.mark).map((old, n) => (n === k ? value : old)).join(kind.mark); redo(); };
    if (isNaN(values[0])) return choice(label, values, option[1].split(kind.mark)[k], set);
    const slider = make('input', {type: 'range', min: values[0], max: values[1], step: values[2]});
    slider.value = option[1].split(kind.mark)[k];
    slider.oninput = () => set(String(+(+slider.value).toPrecision(6)));
    return make('label', {}, label + ' ', slider);
  });
}
function showNumbers([heads, ...rows], text) {
  const known = heads.map((head, k) => [head, ...rows.map(row => row[k])]).filter(line => line.slice(1).some(value => value !== 'NaN' && value !== ''));
  $('numbers').replaceChildren(make('table', {}, ...known.map(([head, ...values]) => {
    const [name, ...unit] = head.split('/'), cell = value => make('td', {textContent: value === '' || isNaN(value) ? value : shown(+value, unit.join('/') || '1')});
    return make('tr', {}, make('th', {textContent: name.replaceAll('_', ' ')}), ...values.map(cell));
  })), make('pre', {textContent: text}));
}
function downloads() {
  const step = run.steps[frame.step], link = (name, of) => make('a', {className: 'button', textContent: name, href: address('file', {...place(), of}), download: name});
  const save = (text, tool, options, name) => button(text, trying(async () => {
    tell(`${tool} makes ${name} …`);
    const made = make('a', {href: URL.createObjectURL(await (await ask('made', query(tool, options, name))).blob()), download: name});
    made.click();
    tell(`${name} is saved.`);
    setTimeout(() => URL.revokeObjectURL(made.href), 60000);
  }), {name});
  const options = framed(VIEWS[view].tool ? [] : VIEWS[view].options ?? []), contact = steps.find(other => other.tool === 'rc-solve');
  const known = tables['rc-report'].options.map(row => row.name), page = contact ? given(contact.options).filter(([name]) => known.includes(name)) : [];
  const formats = tables['rc-export'].options.find(row => row.name === 'format').words;
  $('save').replaceChildren('Save: ', link(step.output, 'stream'), ...(step.report ? [link(step.report, 'report')] : []),
    ...['png', 'svg', 'pdf'].map(suffix => save(suffix.toUpperCase(), 'rc-render', options, `${frame.channel}-${view.toLowerCase()}.${suffix}`)),
    save('Report page', 'rc-report', page, 'report.html'),
    choice('', [['Other format …', ''], ...formats], '', format => save('', 'rc-export', framed([['format', format]]), `${frame.channel}.${format}`).click()),
    button('Copy all commands', () => navigator.clipboard.writeText(run.steps.map(other => other.command + '\n').join(''))));
}

// ---- the beginning ----

const upload = trying(async chosen => {
  if (!chosen) return;
  if (chosen.size > most) throw new Error(`${chosen.name} has ${(chosen.size / 2 ** 30).toFixed(1)} GB, the page takes at most ${most / 2 ** 30} GB: use rc-import in a shell.`);
  tell(`Reading ${chosen.name} …`);
  begin(await (await ask('upload', {name: chosen.name}, chosen)).json());
});
trying(async () => {
  const desk = await (await ask('desk')).json(), kept = JSON.parse(sessionStorage.getItem('work'));
  ({tables, most} = desk);
  $('most').textContent = most / 2 ** 30;
  for (const {tool, step} of Object.values(tables)) if (step && tool !== 'rc-import') $('add').add(new Option(`${TITLES[tool.slice(3)] ?? tool} (${tool})`, tool));
  $('views').append(...Object.keys(VIEWS).map(value => make('label', {}, make('input', {type: 'radio', name: 'view', value, checked: value === view,
    onchange: () => { view = value; show(); }}), make('span', {textContent: value}))));
  const events = new EventSource('events');
  events.onmessage = e => { runs = JSON.parse(e.data); news(); };
  events.onerror = () => tell('There is no connection to rc-app. It has ended, or four pages are open already.', 'failed');
  const [sample, opened] = desk.first;
  $('sample').hidden = sample === null;
  $('sample').onclick = () => begin(desk.files[sample]);
  if (kept && desk.files[kept.file.id]?.path === kept.file.path) { ({file, steps} = kept); drawSteps(); } else if (opened !== null) begin(desk.files[opened]);
})();
$('file').onchange = () => upload($('file').files[0]);
$('file').onkeydown = e => { if (e.key === 'Enter') { e.preventDefault(); $('file').click(); } };
for (const name of ['dragover', 'dragleave', 'drop']) document.addEventListener(name, e => { e.preventDefault(); $('drop').classList.toggle('over', name === 'dragover'); });
document.addEventListener('drop', e => upload(e.dataTransfer.files[0]));
$('add').onchange = () => { add($('add').value, steps.length); $('add').value = ''; drawSteps(); steps.at(-1).card.querySelector('input')?.focus(); };
$('go').onclick = () => start(99);
$('cancel').onclick = trying(() => ask('remove', {run: run.number}, ''));
$('channel').onchange = () => { $('channel').dataset.kept = $('channel').value; channels(); };
$('which').onchange = show;
$('quit').onclick = trying(async () => { await ask('quit', {}, ''); document.body.textContent = 'rc-app has ended. You can close this page.'; });
document.addEventListener('keydown', e => {
  if (e.key === 'Enter' && e.ctrlKey && file) start(99);
  if (e.key === 'Escape' && active(run)) $('cancel').click();
});
