// SPDX-License-Identifier: GPL-3.0-or-later
'use strict';
// The page: forms from the option tables, runs on the server, views of their results. The tools do all work.

const $ = id => document.getElementById(id);
// Steps: their titles, and the options that a new one begins with: examples that run after the first contact.
const STEPS = {
  import: ['Read the file'],
  pick: ['Crop, resample, turn'],
  detrend: ['Level and filter', {poly: '2', spikes: '5', fill: true}],
  solve: ['Press', {load: '1N', body1: 'steel', body2: 'steel', hardness: '6GPa'}],
  stress: ['Stresses below', {section: 'y=0', depths: 'auto'}],
  slip: ['Friction', {mu: '0.3', tangential: '0.1N'}],
  wear: ['Wear', {coefficient: '1e-7mm3/Nm', distance: '1m'}],
  heat: ['Flash temperatures', {mu: '0.3', speed: '1m/s', body1: 'steel', body2: 'steel'}],
  fatigue: ['Fatigue', {'bending-limit': '600MPa', 'torsion-limit': '400MPa', pass: 'x', depths: 'auto'}],
  deflect: ['Displacement'],
  leak: ['Leakage', {viscosity: '1mPas', 'pressure-drop': '100kPa'}],
  add: ['Compare with a second scan', {second: '', measured: 'after', subtract: true, align: true}],
};
// Views, and the options of rc-render (for Numbers, of rc-info) that they begin with.
const VIEWS = {
  Map: [], Figure: [], Relief: [['view', '30,40']], Profile: [['cut', 'y=0']],
  Distribution: [['histogram', true]], Curves: [['curve', 'load:contact_area']], Numbers: [],
};
// Titles of options whose name says too little.
const TITLES = {
  nx: 'Nodes along x', ny: 'Nodes along y', dx: 'Spacing along x', dy: 'Spacing along y', load: 'Load',
  estar: 'Modulus E* of both bodies', E1: 'Young’s modulus, body 1', nu1: 'Poisson’s ratio, body 1',
  E2: 'Young’s modulus, body 2', nu2: 'Poisson’s ratio, body 2', nu: 'Poisson’s ratio', body1: 'Material, body 1',
  body2: 'Material, body 2', radius: 'Ball of radius', cylinder: 'Roller of radius', mu: 'Friction coefficient',
  periodic: 'The map repeats', poly: 'Remove form of degree', plane: 'Remove tilt', sphere: 'Remove sphere',
  spikes: 'Remove spikes above', outliers: 'Remove outliers above', fill: 'Fill missing points', taper: 'Taper the edges',
  highpass: 'Remove waves longer than', lowpass: 'Remove waves shorter than', robust: 'Robust filters',
  crop: 'Cut out a part', resample: 'New spacing or size', set: 'Set a key', section: 'Section at', depths: 'Depths',
  tol: 'Tolerance', yield: 'Yield stress', tangential: 'Tangential force', coefficient: 'Wear coefficient',
  distance: 'Sliding distance', displacement: 'Displacement along the surface', creep: 'Creepage',
  hardness: 'Hardness', conductivity: 'Thermal conductivities', diffusivity: 'Thermal diffusivities',
  'bending-limit': 'Endurance limit in bending', 'torsion-limit': 'Endurance limit in torsion', speed: 'Sliding speed', pass: 'Passes along', view: 'Direction of view', cut: 'Cut at',
  second: 'Second scan', measured: 'Second scan measured', subtract: 'Change between the scans',
  align: 'Shift and turn one onto the other',
  'rc-detrend cylinder': 'Remove cylinder', 'rc-add spikes': 'Remove spikes of both scans above',
  psd: 'Power spectrum', areal: 'Areal parameters', output: 'Frames to write', mean: 'Mean',
};
// Titles of figures beside those of the tables.
const FIGURES = {
  shift_x: 'Shift along x', shift_y: 'Shift along y', shift_error: 'Uncertainty of the shift (95 %)',
  rotation_error: 'Uncertainty of the rotation (95 %)', tilt_x: 'Tilt along x', tilt_y: 'Tilt along y',
  residual: 'Residual of the unchanged part', max_mises: 'Largest Mises stress in the section or at the depths',
  max_mises_depth: 'Its depth', volume: 'Volume of the change',
  volume_error: 'Uncertainty of the volume (95 %)', overlap: 'Part that overlaps', changed: 'Part that has changed',
  missing: 'Part that is missing', nx: 'Nodes along x', ny: 'Nodes along y', dx: 'Spacing along x', dy: 'Spacing along y',
};
// What lowers an estimated error, if it is not the grid.
const OF_SOLVER = {tol: ' (relative, of the solver, not of the grid)'};
// A change, by the scan that was measured later.
const LESS = {first: 'first scan less second', second: 'second scan less first'};
// What the page says of the states of steps and of runs.
const STATES = {running: 'running', short: 'accuracy not reached', failed: 'failed', stopped: 'cancelled'};
const WORDS = {waiting: 'Waiting for other runs …', done: 'Done.', stopped: 'Cancelled.',
  short: 'Done, but a tool stopped short of the requested accuracy: see its message.'};
let tables, most, file = null, steps = [], runs = [], run = null, seen = '', frames = [], frame, view = 'Map';
let shows = 0, ids = 0, added = null; // added: the tool of a step whose result is shown when it has run

function make(tag, more = {}, ...inside) {
  const element = Object.assign(document.createElement(tag), more);
  for (const name of Object.keys(more)) if (name.includes('-')) element.setAttribute(name, more[name]);
  element.append(...inside);
  return element;
}
const button = (textContent, onclick, more) => make('button', {textContent, onclick, ...more});
const hint = textContent => make('p', {className: 'hint', textContent});
const address = (at, query) => at + '?' + new URLSearchParams(query);
async function ask(at, query, body) {
  const answer = await fetch(address(at, query), body === undefined ? {} : {method: 'POST', body});
  if (!answer.ok) throw new Error(await answer.text());
  return answer;
}
const json = async (...given) => (await ask(...given)).json();
function tell(textContent, className = '') { Object.assign($('said'), {textContent, className}); }
const trying = act => async (...given) => {
  try { await act(...given); } catch (e) { tell(e.message, 'failed'); }
};
// Files and studies are made one after another, each of the result that is shown when its button is pressed.
// jobs: the tools of those that have not ended. Their messages have a line of their own, beside that of the runs.
const jobs = [];
let lastJob = Promise.resolve();
function note(textContent, className = '', ...line) {
  Object.assign($('job'), {textContent, className});
  $('made').replaceChildren(...line);
}
function queued(tool, act) {
  const at = place();
  jobs.push(tool);
  if (jobs.length > 1) note(`${tool} waits until ${jobs.at(-2)} has ended.`);
  lastJob = lastJob.then(() => act(at)).catch(e => note(e.message, 'failed')).then(() => { jobs.shift(); });
}
function command(textContent) {
  const copy = button('Copy', async () => {
    await navigator.clipboard.writeText(textContent + '\n');
    copy.textContent = 'Copied';
  });
  return make('div', {className: 'command'}, make('code', {textContent}), copy);
}
function choice(title, words, act) {
  // each a word, or [text, word, whether it cannot be chosen]
  const options = words.map(word => {
    const [text, value = text, disabled = false] = [word].flat();
    return Object.assign(new Option(text, value), {disabled});
  });
  const select = make('select', {'aria-label': title, onchange: () => act(select.value)},
    new Option(title + ' …', ''), ...options);
  return select;
}

// ---- forms: a row for each option of a command ----

const isFlag = row => row.argument === null && !row.words.length;
// Whether two options never go together, by the rules in the tables.
const plain = rule => rule.options.filter(({word}) => !word).map(({name}) => name);
const excludes = (row, name) => row.against.some(rule => !rule.words.length && plain(rule).includes(name));
const clash = (rows, a, b) => a !== b && rows.some(row => row.name === a && excludes(row, b) || row.name === b && excludes(row, a) ||
  row.one_of.some(rule => plain(rule).includes(a) && plain(rule).includes(b)));
// Words for people: the title of an option, and its help with the words that it takes.
const named = (name, tool) => TITLES[`${tool} ${name}`] ?? TITLES[name] ??
  name[0].toUpperCase() + name.slice(1).replaceAll('-', ' ');
const figureOf = (name, tool) => tables[tool]?.figures.find(row => row.name === name);
const figured = (name, tool) => (figureOf(name, tool)?.title ?? FIGURES[name] ??
  name[0].toUpperCase() + name.slice(1).replaceAll('_', ' ')) + (OF_SOLVER[figureOf(name, tool)?.by] ?? '');
// Estimated errors are relative: shares, of which those of the solver say nothing of the grid.
const isError = (name, tool) => figureOf(name, tool)?.role === 'error' || /_error_estimate$/.test(name);
// A message of a tool names options as a shell has them: the form has titles.
const spoken = (words, tool) => words.replace(/--([a-zA-Z][a-zA-Z0-9-]*)/g, (whole, name) =>
  (tables[tool]?.options.some(row => row.name === name) ? `“${named(name, tool)}” (${whole})` : whole));
const helped = ({help, words}) => help.replaceAll('%s', words.join(', '));
const given = options => options.filter(([, value]) => value !== '' && value !== false);
// changed() follows a new value, redo() another number of the options [[name, value], ...].
function form(tool, options, changed, redo) {
  const rows = tables[tool].options, row = name => rows.find(other => other.name === name);
  const others = rows.filter(({name, repeats}) => repeats || options.every(([other]) => name !== other));
  // What an option excludes or needs stands beside its title; what is excluded cannot be chosen.
  const hidden = name => options.map(([other]) => other).filter(other => clash(rows, name, other));
  const lacks = ({needs}) => needs.filter(rule => !rule.words.length).map(plain)
    .find(names => names.length && !options.some(([other]) => names.includes(other)));
  const titles = names => names.map(other => `“${named(other, tool)}”`);
  const offer = one => {
    const barred = hidden(one.name), wants = lacks(one) ?? [], shut = wants.filter(name => hidden(name).length);
    const by = barred.length ? barred : shut.length && shut.length === wants.length ? hidden(shut[0]) : [];
    const why = barred.length ? `not with ${titles(barred).join(', ')}`
      : wants.length ? `needs ${titles(wants).join(' or ')}${by.length ? `, which does not go with ${titles(by).join(', ')}` : ''}` : '';
    return [`${named(one.name, tool)}${why && ` (${why})`}: ${helped(one)}`, one.name, by.length > 0];
  };
  const drop = option => { options.splice(options.indexOf(option), 1); redo(); };
  const enter = name => { options.push([name, isFlag(row(name)) || '']); redo(); };
  return make('div', {}, ...options.map(option => formRow(tool, row(option[0]), option, changed, drop)),
    choice(tool === 'known' ? 'Add what you know' : 'Add an option of ' + tool, others.map(offer), enter));
}
function formRow(tool, row, option, changed, drop) {
  const {name, words, units, rules} = row, key = isFlag(row) ? 'checked' : 'value', id = 'field' + ++ids;
  const chosen = row.only_words && row.type === 'choice', type = isFlag(row) ? 'checkbox' : 'text';
  const offers = chosen || !words.length ? [] : [make('datalist', {id: id + 'words'}, ...words.map(word => new Option(word)))];
  const field = chosen ? make('select', {id}, ...words.map(word => new Option(word)))
    : make('input', {id, type, spellcheck: false, autocomplete: 'off', placeholder: row.argument ?? ''});
  if (offers.length) field.setAttribute('list', id + 'words');
  if (chosen) option[1] ||= words[0];
  field[key] = option[1];
  field.oninput = () => { option[1] = field[key]; changed(); };
  // A file of this machine becomes one of the page; the steps stay those of the first scan.
  const chooser = row.argument !== 'FILE' ? [] : [make('input', {type: 'file', 'aria-label': 'Choose a file: ' + named(name, tool),
    onchange: trying(async () => {
      field.value = option[1] = (await sent(chooser[0].files[0])).name;
      tell(`${option[1]} is on this page now.`);
      changed();
    })})];
  const unit = units.length ? ` Units: ${units.join(', ')}; without a unit it is ${row.unit}.` : '';
  const label = make('label', {htmlFor: id, textContent: named(name, tool)});
  return make('div', {className: 'option', 'data-name': name}, label, field, ...offers,
    button('✕', () => drop(option), {'aria-label': 'Remove ' + named(name, tool)}), ...chooser,
    hint(`--${name}: ${helped(row)}${rules && '; ' + rules}.${unit}`));
}

// ---- steps ----

// Steps that do something; each after the last contact reads that contact, unless it changes the surface. A second
// scan is compared with the first one as it was read and cropped: both have their form.
const NEEDED = {'rc-pick': () => true, 'rc-add': ([name]) => name === 'second'};
const used = () => steps.filter(({tool, options}, k) => !k || !NEEDED[tool] || given(options).some(NEEDED[tool]));
const asked = all => all.map(({tool, options}, k) => {
  const contact = all.slice(0, k).map(other => other.tool).lastIndexOf('rc-solve') + 1;
  const raw = all.findIndex(other => !/import|pick/.test(other.tool));
  const from = tool === 'rc-add' ? raw : /pick|detrend|solve/.test(tool) ? k : contact || k;
  return {tool, options: given(options), from};
});
const ordered = (all, start) => json('steps', {}, JSON.stringify({file: file.id, steps: asked(all), start}));
const title = tool => STEPS[tool.slice(3)]?.[0] ?? tool;
function add(tool, at) {
  steps.splice(at, 0, {tool, options: Object.entries(STEPS[tool.slice(3)]?.[1] ?? {}), open: true});
}
function begin(chosen) {
  file = chosen;
  // The part that was cropped and the name belong to the file before.
  for (const step of steps.filter(({tool}) => tool === 'rc-pick'))
    step.options = step.options.filter(([name, value]) => name !== 'crop' && !/^stream=/.test(value));
  if (!steps.length) ['rc-import', 'rc-pick', 'rc-detrend', 'rc-solve', 'rc-stress'].forEach(add);
  steps = steps.filter(step => step.tool !== 'rc-import');
  if (!file.stream) add('rc-import', 0);
  else if (steps[0]?.tool !== 'rc-pick') add('rc-pick', 0);
  // rc-pick wants something to do.
  if (file.stream && !steps[0].options.length) steps[0].options.push(['set', 'stream=' + file.name]);
  for (const step of steps) step.open = /detrend|solve/.test(step.tool);
  drawSteps();
  start(1);
}
function drawSteps() {
  $('source').textContent = `${file.name}, ${shown(file.size, 'B', 3)}`;
  $('go').disabled = $('add').disabled = false;
  $('steps').replaceChildren(...steps.map((step, k) => {
    const {tool, open, options} = step, head = make('h2', {textContent: title(tool)});
    const remove = button('Remove', () => { steps.splice(k, 1); drawSteps(); }, {hidden: k === 0});
    Object.assign(step, {line: make('div'), state: make('span', {className: 'state'}), shown: ''});
    step.card = make('details', {open, ontoggle: () => { step.open = step.card.open; }},
      make('summary', {}, head, make('code', {textContent: tool}), step.state),
      hint(tables[tool].summary + '.'), form(tool, options, changed, drawSteps), step.line, remove);
    return step.card;
  }));
  changed();
}
function changed() {
  const kept = steps.map(({tool, options, open}) => ({tool, options, open}));
  sessionStorage.setItem('work', JSON.stringify({file, steps: kept}));
  mark();
  clearTimeout(changed.later);
  changed.later = setTimeout(trying(async () => {
    const all = used(), {commands} = await ordered(all, false);
    for (const step of steps) step.command = commands[all.indexOf(step)];
    states();
    if (!$('known').contains(document.activeElement)) drawKnown(); // a field that is being filled stays
  }), 150);
}
// The state of each step, if the selected run has the same command on this file.
function states() {
  const done = run?.file === file?.id ? run?.steps ?? [] : [];
  for (const step of steps) {
    const {state, words = '', seconds} = done.find(other => other.command === step.command) ?? {};
    const ended = state === 'done' ? `done, ${seconds.toFixed(1)} s` : STATES[state] ?? '';
    step.card.dataset.state = state ?? '';
    step.state.textContent = step.command ? ended : 'not used';
    if (step.shown === step.command + words) continue; // a selection of the text stays
    step.shown = step.command + words;
    if (state === 'failed') step.card.open = true; // its options may mend it
    step.line.replaceChildren(...(step.command ? [command(step.command)] : []),
      make('p', {className: 'said', textContent: spoken(words, step.tool)}));
  }
}
const start = trying(async count => {
  tell('Starting …');
  select((await ordered(used().slice(0, count), true)).run);
});

// ---- runs ----

const active = one => one?.state === 'running' || one?.state === 'waiting';
const isRead = one => one.state === 'done' && one.steps.length === 1 && /import|pick/.test(one.steps[0].tool);
const ended = one => (isRead(one) && used().length > 1 ? 'File read. Press “Run all steps”.' : WORDS[one.state]);
const well = step => step.state === 'done' || step.state === 'short';
function select(number) {
  run = runs.find(other => other.number === number) ?? {number, state: 'waiting', steps: []};
  seen = '';
  news();
}
const drop = trying(number => ask('remove', {run: number}, ''));
function news() {
  run = runs.find(other => other.number === run?.number) ?? (active(run) ? run : runs.at(-1) ?? null);
  const names = runs.map(one => new Option(`Run ${one.number}: ${isRead(one) ? 'file read' : STATES[one.state] ?? one.state}`, one.number));
  const said = names.map(option => option.text).join('');
  if ($('runs').textContent !== said) $('runs').replaceChildren(...names); // an open list stays
  $('runs').value = run?.number ?? '';
  states();
  $('cancel').disabled = !active(run);
  $('remove').disabled = !run || active(run);
  $('runs').hidden = $('remove').hidden = !run;
  $('result').hidden ||= !run;
  if (!run) return;
  const [now, failed] = ['running', 'failed'].map(state => run.steps.find(step => step.state === state));
  $('progress').value = (run.steps.filter(well).length + (now?.progress ?? 0)) / (run.steps.length || 1);
  document.body.dataset.run = `${run.number} ${run.state}`;
  if (seen === document.body.dataset.run && !now) return;
  seen = document.body.dataset.run;
  const doing = now ? `${now.tool}: ${now.doing || 'running'}` : ended(run);
  tell(failed ? spoken(failed.words, failed.tool) : doing, failed && 'failed');
  if (!active(run)) collect();
}
// The frames of all steps of the selected run.
const collect = trying(async () => {
  const {number} = run, found = [], kept = $('channel').dataset.kept;
  for (const [step, one] of run.steps.entries()) {
    for (const [n, f] of (well(one) ? await json('frames', {run: number, step}) : []).entries()) {
      const change = f.channel === 'height' && one.later;
      const name = [change ? `change of height (${LESS[change]})` : f.channel, 'after ' + one.tool,
        f.case && 'case ' + f.case, f.load && shown(+f.load, 'N'),
        f.depth && shown(+f.depth, 'm') + ' deep'].filter(Boolean).join(', ');
      found.push({dunit: 'm', ...f, nx: +f.nx, ny: +f.ny, dx: +f.dx, dy: +f.dy, run: number, step, n, name});
    }
  }
  if (run?.number !== number) return;
  frames = found;
  $('result').hidden = !frames.length;
  $('effects').hidden = !run.steps.some(step => step.tool === 'rc-solve' && well(step));
  $('accuracy').hidden = $('effects').hidden;
  $('verdicts').replaceChildren(); // they belong to the contact before
  $('bars').replaceChildren();
  $('channel').replaceChildren(...frames.map((f, k) => new Option(f.name, k)));
  const last = ['pressure', 'height', frames.at(-1)?.channel].map(name => f => f.channel === name);
  const places = [f => f.name === kept, ...last].map(test => frames.findLastIndex(test));
  const ours = f => run.steps[f.step].tool === added, others = new Set(frames.filter(f => !ours(f)).map(f => f.channel));
  const fresh = frames.findIndex(f => ours(f) && !others.has(f.channel)); // of a channel that no other step has
  const own = added === null ? -1 : fresh >= 0 ? fresh : frames.findIndex(ours);
  $('channel').value = own >= 0 ? own : places.find(k => k >= 0);
  if (own >= 0) {
    added = null;
    $('channel').dataset.kept = frames[own].name;
  }
  if (frames.length) show();
});

// ---- views ----

const map = new MapView($('map'), text => { $('at').textContent = text; });
const place = () => ({run: frame.run, step: frame.step});
const runShown = () => runs.find(({number}) => number === frame.run) ?? run; // another one may be selected and work
const show = trying(async () => {
  const turn = ++shows, valid = () => turn === shows;
  frame = frames[$('channel').value];
  $('map').hidden = $('dials').hidden = view !== 'Map';
  $('picture').hidden = view === 'Map' || view === 'Numbers';
  $('numbers').hidden = view !== 'Numbers';
  $('look').hidden = $('sliders').hidden = view === 'Map';
  $('stage').classList.add('busy');
  downloads();
  try {
    await (view === 'Map' ? showMap : showMade)(frame, valid);
  } catch (e) {
    if (!valid()) return;
    $('map').hidden = $('picture').hidden = true; // they are those of another view
    $('numbers').hidden = false;
    $('numbers').replaceChildren(make('p', {className: 'failed', textContent: e.message}));
    $('at').textContent = '';
    $('stage').classList.remove('busy');
    show.failed = e.message;
    throw e;
  }
  if (!valid()) return;
  if ($('said').textContent === show.failed) tell(ended(run) ?? ''); // it was of another view
  document.body.dataset.shown = `${run.number} ${view} ${frame.channel}`;
  $('stage').classList.remove('busy');
});
const keeps = channel => (channel === 'gap' ? 'smallest' : /height|displacement/.test(channel) ? 'mean' : 'largest');
async function valuesOf(f) {
  const bytes = await (await ask('values', {...place(), frame: f.n})).arrayBuffer();
  return f.type === 'f32' ? new Float32Array(bytes) : new Float64Array(bytes);
}
// Whether a few heights would take most of the colours, as spikes do.
async function spiky(f) {
  if (keeps(f.channel) !== 'mean' || f.nx * f.ny > 1 << 25) return false;
  const values = await valuesOf(f), [low, high] = extremes(values), [from, to] = clipped(values, low, high);
  return from > low || to < high;
}
async function showMap(f, valid) {
  const {channel, unit} = f, size = `${f.nx} × ${f.ny} nodes`, keep = keeps(channel);
  $('crop').hidden = Boolean(f.section); // it is not a part of the scan
  if (f.nx * f.ny > 1 << 25)
    throw new Error(`The map has ${size}, the page draws at most 33 million: choose Figure, or resample it.`);
  const values = await valuesOf(f);
  if (!valid()) return;
  await map.show(f.section ? evenly(f, values) : {...f, values}, keep, async (low, high) => {
    const answer = await ask('colours', {channel, unit, low, high});
    const g = make('canvas', {width: 257, height: 1}).getContext('2d');
    g.drawImage(await createImageBitmap(await answer.blob()), 0, 0);
    return new Uint32Array(g.getImageData(0, 0, 257, 1).data.buffer);
  });
  const clips = map.low > map.least || map.high < map.most;
  f.clips = clips;
  downloads(); // its pictures have the same colours
  $('at').textContent = `${size}, ${shown(map.least, unit)} to ${shown(map.most, unit)}` +
    (clips ? `; colours from ${shown(map.low, unit, 3)} to ${shown(map.high, unit, 3)}. ` : '. ') +
    'Wheel or + and − zoom, drag or arrow keys move, 0 shows all.';
  $('map').setAttribute('aria-label', `Map of ${channel}: ${$('at').textContent}`);
}
function crop() {
  const [c, r, d, s] = map.part();
  if (!steps.some(step => step.tool === 'rc-pick')) add('rc-pick', 1);
  const pick = steps.find(step => step.tool === 'rc-pick');
  pick.options = pick.options.filter(([name]) => name !== 'crop');
  pick.options.push(['crop', `${c},${r},${d - c + 1},${s - r + 1}`]);
  pick.open = true;
  drawSteps();
  tell('The step “Crop” has this part of the map now. Run the steps to use it.');
}
// The frame and the view as options of a tool.
function framed(options, colours = true) { // colours: those of a picture
  const has = name => options.some(option => option[0] === name);
  const more = has('curve') ? [] : ['channel', 'case', 'depth'].filter(name => frame[name] && !has(name));
  const clips = colours && frame.clips && /Map|Figure|Relief/.test(view) && !has('clip') && !has('range') ? [['clip', true]] : [];
  return [...more.map(name => [name, frame[name]]), ...clips, ...given(options)];
}
const made = (tool, options, name, at = place()) => ask('made', {...at, tool, options: JSON.stringify(options), name});
const rowsOf = report => report.trim().split('\n').map(line => line.split('\t'));
// The reports of the other steps of the run, of the last one first.
const reportsBeside = at => Promise.all([...runShown().steps.entries()].reverse()
  .filter(([step, one]) => step !== at && one.report && well(one))
  .map(async ([step, one]) => [one, rowsOf(await (await ask('file', {run: frame.run, step, of: 'report'})).text())]));
async function showMade(f, valid) {
  const numbers = view === 'Numbers', tool = numbers ? 'rc-info' : 'rc-render', options = VIEWS[view];
  const redo = () => { clearTimeout(show.later); show.later = setTimeout(show, 300); };
  const again = () => { document.activeElement.blur(); show(); };
  const areal = f.channel === 'height' ? [['areal', true]] : [];
  if (/Figure|Relief/.test(view)) f.clips ??= await spiky(f);
  if (!valid()) return;
  const words = numbers ? [...areal, ...given(options)] : framed(options);
  const free = id => !$(id).contains(document.activeElement);
  if (free('sliders')) $('sliders').replaceChildren(...sliders(f, options[0], redo));
  if (free('look')) $('look').replaceChildren(make('div'), form(tool, options, redo, again));
  const curve = !numbers && given(options).find(([name]) => name === 'curve')?.[1], one = runShown().steps[f.step];
  const table = (numbers || curve) && one.report ? await ask('file', {...place(), of: 'report'}) : null;
  const lines = rowsOf(await table?.text() ?? ''), others = numbers ? await reportsBeside(f.step) : [];
  const heads = lines[0].map(head => head.split('/')[0]), lacking = curve === VIEWS.Curves[0][1] && table &&
    curve.split(/[:,]/).filter(name => !heads.includes(name));
  if (lacking?.length && valid())
    throw new Error(`The report of ${one.tool} has no ${lacking.map(name => name.replaceAll('_', ' ')).join(' and no ')}: ` +
      'choose the result of a contact with several loads, or columns of this report in the option “Curve”: ' + heads.join(', ') + '.');
  const answer = await made(tool, words, numbers ? 'numbers.txt' : 'figure.png'), blob = await answer.blob();
  const header = name => decodeURIComponent(answer.headers.get(name)), text = numbers && await blob.text();
  if (!valid()) return;
  $('numbers').hidden = !numbers && !(curve && lines.length === 2);
  $('picture').hidden = !$('numbers').hidden;
  $('look').firstChild.replaceWith(command(header('X-Command')));
  $('at').textContent = header('X-Words');
  if (numbers) return showNumbers(lines, text, one, others);
  if (!$('numbers').hidden) return showPoint(...lines, curve.split(/[:,]/));
  URL.revokeObjectURL($('picture').src);
  Object.assign($('picture'), {src: URL.createObjectURL(blob), alt: `${view} of ${f.channel}`});
}
// Sliders for numbers of the first option of a view: [name, least, most, step], or null for no slider.
const SLIDERS = {
  view: [',', () => [['Turn', -180, 180, 5], ['Tilt', 5, 90, 5]]],
  cut: ['=', f => [null, ['Place', -f.nx * f.dx / 2, f.nx * f.dx / 2, f.dx]]],
};
function sliders(f, option, redo) {
  const [mark, parts] = SLIDERS[option?.[0]] ?? [], values = mark ? option[1].split(mark) : [];
  return values.flatMap((value, k) => {
    const [title, min, max, step] = parts(f)[k] ?? [];
    const slider = make('input', {type: 'range', min, max, step, value});
    slider.oninput = () => {
      values[k] = String(+(+slider.value).toPrecision(6));
      option[1] = values.join(mark);
      redo();
    };
    return title ? make('label', {}, title + ' ', slider) : [];
  });
}
// The figures of the first table, by tool: the first ten that the report has.
const FIRST = {
  solve: ['load', 'mean_pressure', 'max_pressure', 'contact_area', 'contact_fraction', 'approach', 'pressure_error_estimate',
    'converged', 'friction', 'pull_off_load', 'max_plastic_strain', 'plastic_depth', 'mean_gap', 'nodes_per_patch'],
  stress: ['max_mises', 'max_mises_depth', 'mises_error_estimate'],
  slip: ['load', 'limit', 'tangential_x', 'displacement_x', 'stick_fraction', 'largest_slip', 'converged', 'creep_x', 'creep_y',
    'tangential_stiffness', 'dissipated_energy', 'power', 'tangential_y'],
  wear: ['load', 'distance', 'wear_volume', 'max_wear_depth', 'mean_wear_depth', 'wear_error_estimate', 'max_pressure',
    'contact_area', 'converged'],
  heat: ['max_temperature', 'mean_temperature', 'heat_power', 'share_1', 'steady_time', 'temperature_error_estimate', 'converged'],
  fatigue: ['safety', 'crossland', 'dangvan', 'papadopoulos', 'findley', 'shakedown', 'sampling_error_estimate', 'converged'],
  leak: ['flow_rate', 'flow_factor', 'mean_gap', 'percolates', 'critical_gap', 'discretization_error_estimate', 'converged'],
  deflect: ['max_displacement', 'mean_displacement', 'displacement_error_estimate'],
  add: ['volume', 'volume_error', 'shift_x', 'shift_y', 'rotation', 'residual', 'overlap', 'changed'],
};
// The figures of a report that are known, and those of them that are shown first.
const figuresOf = ([heads, ...rows]) => heads.map((head, k) => [head.split('/'), rows.map(row => row[k])])
  .filter(([, values]) => values.some(value => value !== '' && value !== 'NaN'));
function firstOf(figures, tool) {
  const of = name => figures.filter(([[other]]) => other === name);
  return (FIRST[tool.slice(3)] ?? []).flatMap(of).slice(0, 10);
}
// A report has a column for each figure, the page a line. Curves take the names in the list of all figures.
// `others`: the steps of the run beside this one, [[step, report], ...], of which the page has the first figures.
function showNumbers(lines, textContent, {tool, later}, others) {
  const [heads, ...rows] = lines, known = figuresOf(lines), first = firstOf(known, tool), all = make('details', {});
  const table = (some, code, of = tool) => numberTable(some, name =>
    [figured(name, of), ...(code ? [' ', make('code', {textContent: name})] : [])], name => isError(name, of));
  const heading = of => make('h3', {textContent: `${title(of)} (${of})`});
  const more = others.map(([step, report]) => [step.tool, firstOf(figuresOf(report), step.tool)])
    .filter(([, figures]) => figures.length)
    .map(([of, figures]) => make('div', {}, heading(of), table(figures, false, of)));
  all.append(make('summary', {textContent: `All ${known.length} figures of the report`}), table(known, true));
  const [volume, error] = ['volume/m3', 'volume_error/m3'].map(head => +rows[0]?.[heads.indexOf(head)]);
  const lost = later && volume && rows.length === 1 ? [hint(
    `The change is the ${LESS[later]}: below 0 material was removed. ${volume < 0 ? 'Removed' : 'Added'} on balance: ` +
    `${shown(Math.abs(volume), 'm3', 4)} ± ${shown(error, 'm3', 2, volume)} (95 %).`)] : [];
  $('numbers').replaceChildren(...(more.length && known.length ? [heading(tool)] : []), ...lost,
    ...(first.length ? [table(first, false), all] : [table(known, true)]), ...more, make('pre', {textContent}));
}
const valued = (value, unit, share) => (value === '' || isNaN(value) ? value
  : share && !unit.length ? `${shown(100 * value, '1', 2)} %` : shown(+value, unit.join('/') || '1', 4));
function numberTable(lines, head, isShare) {
  return make('table', {}, ...lines.map(([[name, ...unit], values]) => make('tr', {}, make('th', {}, ...head(name)),
    ...values.map(value => make('td', {textContent: valued(value, unit, isShare(name))})))));
}
// One load has no curve: the value of each column, in words.
function showPoint(heads, row, columns) {
  const text = name => {
    const k = heads.findIndex(head => head.split('/')[0] === name);
    return k < 0 ? '' : `${name.replaceAll('_', ' ')} ${valued(row[k], heads[k].split('/').slice(1))}`;
  };
  $('numbers').replaceChildren(make('p', {textContent: columns.map(text).filter(Boolean).join(', ') + '.'}),
    hint('A curve needs several loads in the step “Press”, as in 1N:60N:log:8.'));
}
const save = (tool, options, name) => queued(tool, async at => {
  note(`${tool} makes ${name} …`);
  const answer = await made(tool, options, name, at), href = URL.createObjectURL(await answer.blob());
  make('a', {href, download: name}).click();
  note(`${name} is saved.`, '', command(decodeURIComponent(answer.headers.get('X-Command'))));
  setTimeout(() => URL.revokeObjectURL(href), 60000);
});
function downloads() {
  const {output, report} = runShown().steps[frame.step];
  const link = (download, of) => make('a', {className: 'button', textContent: download, download,
    href: address('file', {...place(), of})});
  const all = ['png', 'svg', 'pdf'].map(suffix => [suffix.toUpperCase(), 'rc-render',
    framed(view === 'Numbers' ? [] : VIEWS[view]), `${frame.channel}-${view.toLowerCase()}.${suffix}`]);
  all.push(['Report page', 'rc-report', null, 'report.html']);
  const formats = tables['rc-export'].options.find(row => row.name === 'format').words;
  $('save').replaceChildren('Save: ', link(output, 'stream'), ...(report ? [link(report, 'report')] : []),
    ...all.map(([text, tool, options, name]) => button(text, () => save(tool, options ?? ofReport(), name), {name})),
    choice('Other format', formats,
      format => save('rc-export', framed([['format', format]], false), `${frame.channel}.${format}`)));
}

// The options of the report: those of the contact, the data typed below Effects and the noise. Of the data, a hardness
// and layers are options of the contact itself, which is the one that was pressed.
function ofReport() {
  const takes = name => tables['rc-report'].options.some(row => row.name === name);
  const data = given(known).filter(([name]) => !/^(hardness|layer)$/.test(name)), names = data.map(([name]) => name);
  const contact = given(pressed()?.options ?? []).filter(([name]) => !names.includes(name));
  const noise = $('noise').value.trim();
  return [...contact, ...data, ...(noise ? [['noise', noise]] : [])].filter(([name]) => takes(name));
}

// ---- effects: the verdicts of rc-scene on the contact, and buttons that add an effect to the steps ----

let known = [['mu', ''], ['yield', '']]; // data of the effects, beside the options of the contact
const pressed = () => steps.find(step => step.tool === 'rc-solve');
// Effects of the contact that rc-scene does not solve: it judges the elastic contact.
const UNJUDGED = ['hardness', 'yield', 'adhesion', 'relaxation', 'travel', 'history'];
const judged = name => tables['rc-scene'].options.some(row => row.name === name);
// The options of the contact that rc-scene takes too; the form asks for none of them.
const carried = () => given(pressed()?.options ?? []).filter(([name]) => judged(name));
function drawKnown() {
  const rows = tables['rc-scene'].options, first = rows.findIndex(row => row.name === 'thickness'), from = carried();
  const has = (name, options) => options.some(([other]) => other === name);
  known = known.filter(([name, value]) => value || !has(name, from));
  tables.known = {options: rows.filter(({name}, k) => (k >= first || name === 'layer' || name === 'hardness') &&
    (has(name, known) || !has(name, from)))};
  const told = from.map(([name, value]) => named(name, 'rc-solve') + (value === true ? '' : ': ' + value));
  $('known').replaceChildren(...(told.length ? [hint(`From the step “Press”: ${told.join('; ')}.`)] : []),
    form('known', known, () => {}, drawKnown));
}
// A study below the result: its message stands where its table would.
const studying = (id, tool, act) => () => queued(tool, async at => {
  try { await act(at); } catch (e) {
    $(id).replaceChildren(make('p', {className: 'said failed', textContent: e.message}));
    throw e;
  }
});
const judge = studying('verdicts', 'rc-scene', async at => {
  if (!pressed()) throw new Error('Add the step “Press” first: the verdicts are about its contact.');
  const own = given(known), names = own.map(([name]) => name);
  const words = [...carried().filter(([name]) => !names.includes(name)), ...own];
  note('rc-scene judges the effects …');
  const answer = await made('rc-scene', words, 'scene.json', at), said = decodeURIComponent(answer.headers.get('X-Words'));
  const lines = (await answer.text()).trim().split('\n').map(line => JSON.parse(line));
  const {scene} = lines[(frame?.case ?? 1) - 1] ?? lines.at(-1), missing = scene.filter(e => !e.sentence);
  const effects = given(pressed().options).map(([name]) => name).filter(name => UNJUDGED.includes(name));
  const lacking = e => `${e.title} (${e.missing.split(' ').map(name => `“${named(name, 'known')}”`).join(', ')})`;
  $('verdicts').replaceChildren(make('p', {className: 'said', textContent: said}),
    ...(effects.length ? [hint('The verdicts are those of the elastic contact, without ' +
      `${effects.map(name => `“${named(name, 'rc-solve')}”`).join(', ')} of the step “Press”.`)] : []),
    make('table', {}, ...scene.filter(e => e.sentence).map(e => make('tr', {}, make('th', {textContent: e.title}),
      make('td', {textContent: e.sentence}),
      offered(e)))),
    hint(missing.length ? 'Data are missing for: ' + missing.map(lacking).join(', ') + '.' : ''));
  mark();
  document.body.dataset.judged = scene.length;
  note('The table below has the verdicts.');
});
// The options of a command, [[name, value], ...], of which the first word is the tool.
function optionsOf([tool, ...words]) {
  const found = [];
  for (const word of words) {
    const [name, ...value] = word.slice(2).split('=');
    if (found.length && !word.startsWith('--')) found.at(-1)[1] = word;
    else found.push([name, value.length ? value.join('=') : undefined]);
  }
  const row = name => tables[tool].options.find(other => other.name === name);
  return found.filter(([name]) => row(name)).map(([name, value]) =>
    [name, value ?? (isFlag(row(name)) ? true : row(name).words[0])]);
}
// Gives the step of each tool the options of the effect, in place of those that exclude them. The contact keeps its
// loads, bodies and shapes; only effects that replace body 1 bring bodies of their own.
const OF_CONTACT = /^(load|mean-pressure|approach|estar|E[12]|nu[12]|radius|cylinder|periodic|datum)$/;
const OF_BODIES = /^(estar|E[12]|nu[12]|body[12])$/;
const withBodies = ({effect}) => /^(thin|relaxation|sliding)$/.test(effect);
// What an effect brings: a tool with its options for each command of its pipe.
function brought(e) {
  const at = e.command.indexOf('|'), all = at < 0 ? [e.command] : [e.command.slice(0, at), e.command.slice(at + 1)];
  const own = ([name]) => !OF_CONTACT.test(name) || withBodies(e) && OF_BODIES.test(name);
  return all.map(words => [words[0], optionsOf(words).filter(option => words[0] !== 'rc-solve' || own(option))]);
}
const present = e => brought(e).every(([tool, options]) => steps.some(step => step.tool === tool &&
  options.every(([name, value]) => step.options.some(option => option[0] === name && option[1] === value))));
// The cell of an effect that a command computes: whether the steps have it now, or a button that adds it.
const offers = new Map();
function offered(e) {
  const cell = make('td');
  if (e.command.length) offers.set(cell, e);
  return cell;
}
function mark() {
  for (const [cell, e] of offers) {
    if (!cell.isConnected) offers.delete(cell);
    else cell.replaceChildren(present(e) ? 'in the steps' : button('Add', () => addEffect(e), {name: e.effect}));
  }
}
function addEffect(e) {
  const bodies = withBodies(e), lost = [];
  for (const [tool, options] of brought(e)) {
    const rows = tables[tool].options, has = name => options.some(option => option[0] === name);
    const step = steps.find(other => other.tool === tool) ?? (steps.push({tool, options: []}), steps.at(-1));
    const barred = name => options.some(option => clash(rows, option[0], name));
    const stays = ([name]) => !has(name) && !barred(name) && !(bodies && tool === 'rc-solve' && OF_BODIES.test(name));
    lost.push(...step.options.filter(([name]) => barred(name) && !has(name)).map(([name]) => `“${named(name, tool)}”`));
    step.options = [...step.options.filter(stays), ...options];
    step.open = true;
    added = tool;
  }
  drawSteps();
  tell(`The steps have this effect now: ${e.title}. ${lost.length ? `It replaces ${lost.join(', ')}. ` : ''}Run the steps to see it.`);
}

// ---- accuracy: the bars of rc-cost, for the noise and the resolution of the scan ----

const measure = studying('bars', 'rc-cost', async at => {
  if (!pressed()) throw new Error('Add the step “Press” first: the bars are those of its contact.');
  const noise = $('noise').value.trim(), words = [...(noise ? [['noise', noise]] : []), ['resolution', true]];
  note('rc-cost solves the contact again with other noise and resolution …');
  const answer = await made('rc-cost', words, 'bars.json', at);
  const rows = (await answer.text()).trim().split('\n').map(line => JSON.parse(line)), number = +(frame?.case ?? 1);
  const figures = rows.filter(row => row.what === 'figure' && row.case === number && (row.bar_relative || row.why));
  const per = value => (value ? `± ${shown(100 * value, '1', 2)} %` : ''), any = figures.some(row => row.bar_relative);
  const alone = row => row.limit === false && row.noise_relative;
  const bar = row => (alone(row) ? `noise alone ${per(row.noise_relative)}, without the error of the grid` : per(row.bar_relative));
  // A grid counts whole nodes, so the area is too large by about the correction.
  const [area, less] = ['contact_area', 'contact_area_corrected'].map(name => rows.find(row => row.what === 'figure' &&
    row.case === number && row.name === name && row.value));
  $('bars').replaceChildren(command(decodeURIComponent(answer.headers.get('X-Command'))),
    make('table', {}, ...figures.map(row => make('tr', {}, make('th', {textContent: row.name.replaceAll('_', ' ')}),
      ...[shown(row.value, row.unit ?? '1', 4), bar(row), row.bar_relative && row.dominant ? 'mostly by ' + row.dominant : '',
        row.why ?? ''].map(textContent => make('td', {textContent}))))),
    ...(any ? [hint('In 90 % of the cases the value of the true surface is within the bar.')] : []),
    ...(figures.some(alone) ? [hint('Noise alone: the error of the grid is not in this bar and may be many times larger. ' +
      '“Judge the effects” says how much a finer grid would change the contact.')] : []),
    ...(area && less ? [hint(`Quote the corrected contact area, ${shown(less.value, 'm2', 4)}, with the spacing of the grid: the contact ` +
      `area counts each node on the edge of the contact as a whole one and is ${shown(100 * (area.value / less.value - 1), '1', 2)} % larger.`)] : []));
  document.body.dataset.measured = figures.length;
  note(any ? 'The table below has the bars.' : 'No figure has a bar: the table below says why.');
});

// ---- the beginning ----

async function sent(chosen) {
  if (chosen.size > most)
    throw new Error(`${chosen.name}: the page takes at most ${most / 2 ** 30} GB: use rc-import in a shell.`);
  tell(`Reading ${chosen.name} …`);
  return json('upload', {name: chosen.name}, chosen);
}
const upload = trying(async chosen => { if (chosen) begin(await sent(chosen)); });
trying(async () => {
  const desk = await json('desk'), kept = JSON.parse(sessionStorage.getItem('work'));
  ({tables, most} = desk);
  for (const {tool, step} of Object.values(tables))
    if (step && tool !== 'rc-import') $('add').add(new Option(`${title(tool)} (${tool})`, tool));
  $('views').append(...Object.keys(VIEWS).map(value => {
    const onchange = () => { view = value; show(); };
    const field = make('input', {type: 'radio', name: 'view', value, checked: value === view, onchange});
    return make('label', {}, field, make('span', {textContent: value}));
  }));
  drawKnown();
  const events = new EventSource('events'), [sample, opened] = desk.first;
  events.onmessage = e => { runs = JSON.parse(e.data); news(); };
  events.onerror = () => tell('No connection to rc-app: it has ended, or four pages are open.', 'failed');
  $('sample').hidden = sample === null;
  $('sample').onclick = () => begin(desk.files[sample]);
  if (kept && desk.files[kept.file.id]?.path === kept.file.path) {
    ({file, steps} = kept);
    drawSteps();
  } else if (opened !== null) begin(desk.files[opened]);
})();
const CLICKS = {
  judge, measure,
  go: () => start(99), cancel: () => drop(run.number), remove: () => drop(run.number), crop,
  all: () => map.fit(), in: () => map.zoom(1.5), out: () => map.zoom(1 / 1.5),
  quit: trying(async () => {
    await ask('quit', {}, '');
    document.body.textContent = 'rc-app has ended. You can close this page.';
  }),
};
for (const [id, act] of Object.entries(CLICKS)) $(id).onclick = act;
$('file').onchange = () => upload($('file').files[0]);
for (const name of ['dragover', 'dragleave', 'drop']) document.addEventListener(name, e => {
  e.preventDefault();
  $('drop').classList.toggle('over', name === 'dragover');
  if (name === 'drop') upload(e.dataTransfer.files[0]);
});
$('add').onchange = () => {
  add(added = $('add').value, steps.length);
  $('add').value = '';
  drawSteps();
  steps.at(-1).card.querySelector('input')?.focus();
};
$('runs').onchange = () => select(+$('runs').value);
$('channel').onchange = () => { $('channel').dataset.kept = frames[$('channel').value].name; show(); };
document.addEventListener('keydown', e => {
  if (e.key === 'Enter' && e.ctrlKey && file) start(99);
  if (e.key === 'Enter' && e.target === $('file')) $('file').click();
  if (e.key === 'Escape' && active(run)) drop(run.number);
});
