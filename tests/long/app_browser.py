# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of rc-app in headless Chromium for pipe_app_browser.sh: app_browser.py CHROMIUM ADDRESS FOLDER.

FOLDER has rough-steel.x3p, broken.x3p, big.x3p (2048 x 2048), jagged.rcg, node.rcg and spike.rcg, and receives downloads and pictures.
"""
import base64
import os
import re
import sys
import time

from playwright.sync_api import sync_playwright

CHROMIUM, ADDRESS, FOLDER = sys.argv[1:4]


def ok(sentence, true, more=''):
    print('%s: %s%s' % ('ok' if true else 'NOT OK', sentence, ' (%s)' % ' '.join(more.split()) if more else ''), flush=True)


def place(name):
    return os.path.join(FOLDER, name)


class Browser:
    def __init__(self, playwright, **context):
        self.browser = playwright.chromium.launch(executable_path=CHROMIUM, args=['--no-sandbox'])
        self.context = self.browser.new_context(**dict({'viewport': {'width': 1440, 'height': 1000}}, **context))
        self.context.grant_permissions(['clipboard-read', 'clipboard-write'])
        self.errors = []

    def open(self):
        page = self.context.new_page()
        page.set_default_timeout(60000)
        page.on('console', lambda message: message.type == 'error' and self.errors.append(message.text))
        page.on('pageerror', lambda error: self.errors.append(str(error)))
        page.goto(ADDRESS)
        page.wait_for_selector('#views input', state='attached')
        return page


def drop(page, name):
    with open(place(name), 'rb') as file:
        data = base64.b64encode(file.read()).decode()
    held = page.evaluate_handle('''([data, name]) => {
        const held = new DataTransfer();
        held.items.add(new File([Uint8Array.from(atob(data), c => c.charCodeAt(0))], name));
        return held;
    }''', [data, name])
    page.dispatch_event('#drop', 'drop', {'dataTransfer': held})


def picture(page, name):
    page.wait_for_timeout(400)
    page.screenshot(path=place('shots/%s.png' % name))


def focus(page, selector):
    """Tabs until this element has the focus: it can be reached by keyboard."""
    for _ in range(120):
        page.keyboard.press('Tab')
        if page.evaluate('selector => document.activeElement.matches(selector)', selector):
            return
    raise AssertionError(selector + ' cannot be reached')


def shown(page, what):
    page.wait_for_selector('body[data-shown*="%s"]' % what, state='attached')
    page.wait_for_selector('#stage:not(.busy)', state='attached')


def saved(page, selector):
    focus(page, selector)
    with page.expect_download() as download:
        page.keyboard.press('Enter')
    download.value.save_as(place(download.value.suggested_filename))
    return os.path.getsize(place(download.value.suggested_filename)), download.value.suggested_filename


def by_keyboard(page):
    """From a scan to downloads without a mouse."""
    picture(page, 'begin')
    page.on('filechooser', lambda chooser: chooser.set_files(place('rough-steel.x3p')))
    page.wait_for_timeout(2000)  # until the browser passes the choice of a file to this program
    focus(page, '#file')
    page.keyboard.press('Enter')
    shown(page, 'Map height')
    ok('by keyboard: the scan is chosen and shown', 'rough-steel.x3p' in page.inner_text('#source'))
    ok('  the page says that only the file was read, and what to press', page.inner_text('#said') == 'File read. Press “Run all steps”.'
       and page.locator('#runs option').all_text_contents()[-1].endswith(': file read'),
       page.inner_text('#said') + ' ' + ', '.join(page.locator('#runs option').all_text_contents()))
    picture(page, 'scan')
    focus(page, '#go')
    page.keyboard.press('Enter')
    shown(page, 'Map pressure')
    ok('by keyboard: it is levelled and pressed', page.get_attribute('body', 'data-run').endswith('done'))
    picture(page, 'map')
    focus(page, '#map')
    for key in ('+', '+', 'ArrowRight', 'ArrowUp'):
        page.keyboard.press(key)
    ok('by keyboard: the map is enlarged and read', 'µm' in page.inner_text('#at') and 'Pa' in page.inner_text('#at'), page.inner_text('#at'))
    page.keyboard.press('0')
    page.focus('#views input:checked')
    for view in 'Figure Relief Profile Distribution Curves Numbers'.split():
        page.keyboard.press('ArrowRight')
        shown(page, view)
        ok('by keyboard: ' + view, page.evaluate('''() => document.querySelector('#picture').naturalWidth > 300 || !document.querySelector('#picture').checkVisibility()'''))
        picture(page, view.lower())
        if view == 'Curves':
            ok('  one load is a value, no curve', 'contact area' in page.inner_text('#numbers') and not page.is_visible('#picture'), page.inner_text('#numbers'))
    numbers = page.inner_text('#numbers')
    ok('  numbers have titles and units', re.search(r'Contact area\t[0-9]{1,4}(\.[0-9]+)? µm²', numbers), numbers[:60].replace('\n', ' '))
    solver = re.search(r'Error of the pressure \(relative, of the solver, not of the grid\)\t([0-9.e−]+) %', numbers)
    told = page.evaluate("""async () => {
        const [heads, row] = rowsOf(await (await ask('file', {...place(), of: 'report'})).text());
        return +row[heads.indexOf('pressure_error_estimate')];
    }""")
    ok('  errors are per cent, and say that they are of the solver', solver and abs(float(solver[1].replace('−', '-')) / 100 / told - 1) < 0.06,
       '%s, %g' % (solver and solver[0], told))
    raw = page.locator('#numbers th').evaluate_all('all => all.map(th => th.firstChild.textContent).filter(text => /_|^[a-z]/.test(text))')
    ok('  no title is the name of a key', not raw, ', '.join(raw))
    ok('  the list of all figures has the names for curves', 'contact_area' in page.locator('#numbers details th code').all_text_contents())
    ok('  the first table is short', page.locator('#numbers > table tr').count() <= 10 and 'figures of the report' in numbers)
    page.focus('#views input:checked')
    page.keyboard.press('ArrowRight')
    shown(page, 'Map')
    for selector in ('#save a', '#save a + a', '#save [name="pressure-map.png"]', '#save [name="pressure-map.pdf"]', '#save [name="report.html"]'):
        size, name = saved(page, selector)
        ok('by keyboard: %s is saved' % name, size > 1000, '%d bytes' % size)
    focus(page, '.command button')
    page.keyboard.press('Enter')
    page.wait_for_selector('.command button:has-text("Copied")')
    ok('by keyboard: a command is copied', page.evaluate('() => navigator.clipboard.readText()').startswith('rc-'))
    with open(place('commands'), 'w') as file:
        file.write('\n'.join(page.locator('#steps .command code').all_text_contents()) + '\n')


def sections(page):
    """The stresses have depths that follow from the pressure; the map shows uneven depths where they are."""
    page.check('#views input[value=Map]', force=True)
    command = page.text_content('details:has(> summary code:text("rc-stress")) .command code')
    ok('the depths of the stresses follow from the pressure', '--section y=0 --depths auto ' in command, command)
    name = next(name for name in page.locator('#channel option').all_text_contents() if name.startswith('mises'))
    page.select_option('#channel', label=name)
    shown(page, 'Map mises')
    page.focus('#map')
    page.keyboard.press('0')
    page.keyboard.press('ArrowUp')
    page.keyboard.press('ArrowDown')
    depths = page.evaluate('() => frame.depths.split(",").map(Number)')
    read = re.match('x .*m, depth ([0-9.]+) µm: [0-9.]+ [kM]?Pa$', page.inner_text('#at'))
    ok('  half way down the picture is half of the depth', read and abs(float(read[1]) * 2e-6 / depths[-1] - 1) < 0.02, page.inner_text('#at'))
    steps = [b - a for a, b in zip(depths, depths[1:])]
    ok('  the depths are uneven', max(steps) > 10 * min(steps), '%g to %g' % (min(steps), max(steps)))
    ok('  a section is not cropped', not page.is_visible('#crop'))
    picture(page, 'section')
    # values that are linear in the depth stay so
    off = page.evaluate('''() => {
        const depths = [1e-6, 1.5e-6, 3e-6, 3.0000000000001e-6, 9e-6], values = depths.flatMap(z => [2 * z + 1e-6, 5e-6 - z]);
        const {ny, dy, top, values: made} = evenly({section: 'y', nx: 2, ny: 5, depths: depths.join()}, values);
        const wrong = (r, c) => made[2 * r + c] - [2 * (top + r * dy) + 1e-6, 5e-6 - top - r * dy][c];
        return [ny, top + (ny - 1) * dy, Math.max(...Array.from({length: 2 * ny}, (_, k) => Math.abs(wrong(k >> 1, k & 1))))];
    }''')
    ok('  rows between the depths are linear', off[0] == 1024 and abs(off[1] - 9e-6) < 1e-18 and off[2] < 1e-17, str(off))
    even = page.evaluate('''() => evenly({section: 'y', nx: 1, ny: 3, depths: '0,1e-06,2e-06'}, [3, 7, 1]).values.join()''')
    ok('  even depths keep their values', even == '3,7,1', even)


def words(page):
    """The forms have words, materials and no indenter; a spike does not take the colours."""
    labels = page.locator('#steps .option label').all_text_contents()
    ok('options have titles in words', 'Load' in labels and 'Material, body 1' in labels and 'Remove spikes above' in labels, ', '.join(labels))
    ok('  the names of the tools are in the line below', page.locator('[data-name="load"] .hint').inner_text().startswith('--load: total normal force'))
    ok('  no text has a %s', '%s' not in page.inner_text('#steps') and '%s' not in ''.join(page.locator('option').all_text_contents()))
    ok('  materials are offered', '100Cr6' in page.locator('[data-name="body1"] datalist option').evaluate_all('all => all.map(o => o.value)'))
    ok('  the first form has no indenter', page.locator('[data-name="radius"]').count() == 0)


def compare(page):
    """A second scan: its difference is shown, with the volume first; Curves says what it needs; the form of the cylinder."""
    page.set_input_files('#file', place('new.x3p'))
    page.wait_for_selector('#source:has-text("new.x3p")')
    page.check('#views input[value=Map]', force=True)
    shown(page, 'Map height')
    page.select_option('#add', value='rc-add')
    page.locator('[data-name=second] input[type=file]').set_input_files(place('worn.x3p'))
    page.wait_for_selector('#said:has-text("worn.x3p is on this page now")')
    when = page.locator('[data-name=measured] select')
    ok('the second scan was measured after the first one',
       when.input_value() == 'after' and when.locator('option').all_text_contents() == ['after', 'before'])
    page.keyboard.press('Control+Enter')
    page.wait_for_selector('body[data-run$=done]', state='attached')
    page.wait_for_selector('#channel option:has-text("rc-add")', state='attached')
    page.wait_for_timeout(2000)
    ok('the result of an added step is shown', page.locator('#channel option:checked').inner_text() == 'change of height (second scan less first), after rc-add')
    ok('  1 µm of wear is a change of −1 µm', abs(page.evaluate('''async () => {
        const values = (await valuesOf(frame)).filter(v => v === v).sort();
        return values[Math.floor(values.length / 50)];
    }''') + 1e-6) < 2e-7, page.inner_text('#at'))
    page.check('#views input[value=Figure]', force=True)
    shown(page, 'Figure height')
    ok('  a spike does not take the colours of its figure', '--clip' in page.inner_text('#look .command code'), page.inner_text('#look .command code'))
    picture(page, 'compare-figure')
    page.check('#views input[value=Curves]', force=True)
    page.wait_for_selector('#numbers .failed')
    ok('  Curves says what it needs, without the old figure', 'The report of rc-add has no load and no contact area' in page.inner_text('#numbers')
       and not page.is_visible('#picture'), page.inner_text('#numbers'))
    page.check('#views input[value=Numbers]', force=True)
    page.wait_for_selector('#numbers table')
    page.wait_for_selector('#stage:not(.busy)', state='attached')
    ok('  the message of Curves goes with its view', 'The report of rc-add' not in page.inner_text('#said'), page.inner_text('#said'))
    ok('  the stresses are called those of the section', 'Largest Mises stress in the section or at the depths' in page.inner_text('#numbers'))
    first = page.locator('#numbers > table th').all_text_contents()
    said = page.inner_text('#numbers .hint')
    removed = re.match('The change is the second scan less first: below 0 material was removed. Removed on balance: ([0-9]+) µm³ ± [0-9.e−]+ µm³ ', said)
    ok('  the removed volume is that of the groove less that of the spike', removed and abs(float(removed[1]) - (1200 - 100)) < 1, said)
    picture(page, 'compare-numbers')
    ok('  the volume is among the first numbers', 'Volume of the change' in first and len(first) <= 10, ', '.join(first))
    page.select_option('select[aria-label="Add an option of rc-detrend"]', value='cylinder')
    labels = page.locator('#steps .option label').all_text_contents()
    ok('rc-detrend removes a cylinder', 'Remove cylinder' in labels and 'Roller of radius' not in labels, ', '.join(labels))
    page.click('button[aria-label="Remove Remove cylinder"]')
    page.click('details:has(> summary code:text("rc-add")) > button:text-is("Remove")')
    page.check('#views input[value=Map]', force=True)


def spikes(page):
    page.set_input_files('#file', place('spike.rcg'))
    page.wait_for_selector('#source:has-text("spike.rcg")')
    page.check('#views input[value=Map]', force=True)
    page.wait_for_selector('#at:has-text("100 × 100 nodes")')
    page.wait_for_selector('#at:has-text("; colours from")')
    low, high = page.evaluate('() => [map.low, map.high]')
    ok('a spike does not take the colours', high < 1.1e-6 and low > -1.1e-6, page.inner_text('#at'))
    marks = page.evaluate('() => rounds(map.low, map.high)')
    ok('  the marks of the colours are round', marks == [-1e-6, -0.5e-6, 0, 0.5e-6, 1e-6][marks[0] > -0.99e-6:][:len(marks)], str(marks))
    ok('  also of other ranges', page.evaluate('() => [rounds(-891e-9, 73e-9), rounds(0, 6e9), rounds(1.2, 1.3)]') ==
       [[-8e-7, -6e-7, -4e-7, -2e-7, 0], [0, 2e9, 4e9, 6e9], [1.2, 1.25, 1.3]],
       str(page.evaluate('() => [rounds(-891e-9, 73e-9), rounds(0, 6e9), rounds(1.2, 1.3)]')))
    picture(page, 'spike')


def accuracy(page):
    """The bars of the figures, as rc-cost gives them."""
    page.check('#views input[value=Map]', force=True)
    shown(page, 'Map')
    page.click('#accuracy summary')
    page.click('#measure')
    page.wait_for_selector('body[data-measured]', state='attached')
    table = page.inner_text('#bars')
    ok('the contact has bars', re.search(r'contact area\t[0-9.]+ µm²\t± [0-9.]+ %\tmostly by ', table), table[:400])
    text = page.inner_text('#bars')
    area, less = (float(re.search(name + r'\t([0-9.]+) µm²', text)[1]) for name in ('contact area', 'contact area corrected'))
    quote = re.search(r'Quote the corrected contact area, ([0-9.]+) µm², with the spacing of the grid: .* is ([0-9.]+) % larger', text)
    ok('  the corrected area is the one to quote', quote and abs(float(quote[1]) / less - 1) < 1e-3
       and abs(float(quote[2]) / (100 * (area / less - 1)) - 1) < 0.06, quote and quote[0])
    page.locator('#accuracy').scroll_into_view_if_needed()
    picture(page, 'accuracy')
    page.evaluate('() => { delete document.body.dataset.measured; }')
    page.set_input_files('#file', place('jagged.rcg'))
    page.wait_for_selector('#source:has-text("jagged.rcg")')
    page.keyboard.press('Control+Enter')
    shown(page, 'Map pressure')
    page.click('#measure')
    page.wait_for_selector('body[data-measured]', state='attached')
    text = page.inner_text('#bars')
    ok('  where a finer grid may show more, the part of the noise says that the error of the grid is not in it',
       re.search(r'contact area\t[0-9.]+ µm²\tnoise alone ± [0-9.]+ %, without the error of the grid\t\ta finer grid may change it further, so give '
                 'the spacing, 1 um, with the value', text) and 'Noise alone: the error of the grid is not in this bar' in text, text[:400])


def errors(page):
    """A broken file, a wrong unit, a cancelled run."""
    drop(page, 'broken.x3p')
    page.wait_for_selector('#said.failed')
    page.wait_for_timeout(500)
    ok('  the step that failed is open', page.get_attribute('details:has(> summary code:text("rc-import"))', 'open') is not None)
    ok('a broken file: the message of rc-import', 'the ZIP archive is damaged or cut off' in page.inner_text('#said'), page.inner_text('#said'))
    picture(page, 'broken')
    drop(page, 'rough-steel.x3p')
    shown(page, 'Map height')
    load = page.locator('details:has(code:text("rc-solve")) input').first
    load.fill('60K')
    page.keyboard.press('Control+Enter')
    page.wait_for_selector('#said.failed')
    ok('a wrong unit: the message of rc-solve', "unknown unit 'K'" in page.inner_text('#said'))
    picture(page, 'error')
    load.fill('1N:60N:4000')
    page.keyboard.press('Control+Enter')
    page.wait_for_selector('#said:has-text("case 2")')
    picture(page, 'progress')
    began = time.time()
    page.keyboard.press('Escape')
    page.wait_for_selector('body[data-run$=stopped]', state='attached')
    ok('Escape cancels a run', time.time() - began < 5, '%.1f s' % (time.time() - began))
    load.fill('1N:60N:log:6')
    page.keyboard.press('Control+Enter')
    page.wait_for_selector('body[data-run$=done]', state='attached')
    shown(page, 'Map pressure')
    page.check('#views input[value=Curves]', force=True)
    shown(page, 'Curves')
    picture(page, 'curves-loads')
    ok('a curve of six loads is drawn', page.evaluate('() => document.querySelector("#picture").naturalWidth > 300'))


def effects(page):
    """The verdicts on the contact; a button adds an effect to the steps."""
    def judge():
        page.evaluate('() => { delete document.body.dataset.judged; }')
        page.click('#judge')
        page.wait_for_selector('body[data-judged]', state='attached')

    def command(tool):
        page.wait_for_timeout(600)
        return page.inner_text('details:has(> summary code:text("%s")) .command code' % tool)

    page.check('#views input[value=Map]', force=True)
    page.locator('details:has(code:text("rc-solve")) input').first.fill('60N')
    page.keyboard.press('Control+Enter')
    page.wait_for_selector('body[data-run$=done]', state='attached')
    shown(page, 'Map pressure')
    page.click('#effects summary')
    for name, value in (('coefficient', '1e-6mm3/Nm'), ('distance', '1m')):
        page.select_option('#known select', value=name)
        page.locator('#known [data-name="%s"] input' % name).fill(value)
    judge()
    table = page.inner_text('#verdicts')
    ok('the contact is judged', 'hardness\tcalls for it: changes the largest pressure by ' in table and 'Data are missing for: ' in table, table[:200])
    ok('  missing data have the titles of their fields', 'Load (' not in table and re.search('Data are missing for: .*“Friction coefficient”', table)
       and '(mu' not in table and 'bending-limit' not in table, table[-500:])
    ok('  the contact that is judged is elastic, which the page says',
       'The verdicts are those of the elastic contact, without “Hardness” of the step “Press”.' in table, table[:300])
    picture(page, 'effects')
    page.click('#verdicts [name=wear]')
    ok('  wear is added as a step', command('rc-wear').startswith('rc-wear --coefficient 1e-6mm3/Nm --distance 1m '), command('rc-wear'))
    offers = page.locator('#known select option').evaluate_all('all => all.map(o => o.value)')
    ok('  the hardness of the contact is carried over', 'hardness' not in offers and 'Hardness: 6GPa' in page.inner_text('#known > .hint')
       and 'hardness\tcalls for it' in table and page.locator('#verdicts tr:has(th:text-is("hardness"))').inner_text().endswith('in the steps'),
       page.inner_text('#known > .hint'))
    picture(page, 'effects-hardness')
    page.click('details:has(> summary code:text("rc-solve")) button[aria-label="Remove Hardness"]')
    page.wait_for_selector('#known option[value=hardness]', state='attached')
    page.select_option('#known select', value='hardness')
    page.locator('#known [data-name=hardness] input').fill('6GPa')
    judge()
    page.click('#verdicts [name=hardness]')
    solve = command('rc-solve')
    ok('  a hardness as an option of the contact', '--hardness 6GPa' in solve and '--load 60N' in solve, solve)
    ok('  the bodies stay', '--body1 steel --body2 steel' in solve and '--E1' not in solve, solve)
    page.click('#verdicts [name=grid]')
    solve = command('rc-solve')
    ok('  a finer grid keeps hardness and bodies', solve.startswith('rc-solve --load 60N --body1 steel --body2 steel --hardness 6GPa --discretization '), solve)
    page.locator('#known [data-name=yield] input').fill('300MPa')
    judge()
    page.click('#verdicts [name=yield]')
    solve = command('rc-solve')
    ok('  a yield stress replaces the options that exclude it, and says so', '--body1 steel --body2 steel --yield 300MPa' in solve
       and 'It replaces “Hardness”, “Discretization”.' in page.inner_text('#said'), solve + page.inner_text('#said'))
    mark = lambda effect: page.locator('#verdicts tr:has(th:text-is("%s")) td' % effect).last.inner_text()
    ok('  the table marks what the steps have now', (mark('hardness'), mark('yield in the volume')) == ('Add', 'in the steps'),
       page.inner_text('#verdicts'))
    page.click('details:has(> summary code:text("rc-solve")) button[aria-label="Remove Yield stress"]')
    names = page.locator('select[aria-label="Add an option of rc-solve"] option').all_text_contents()
    ok('  an option that is excluded says by what', any(name.startswith('Time (needs “Relaxation”): ') for name in names), str(names))
    page.select_option('select[aria-label="Add an option of rc-solve"]', value='hardness')
    names = page.locator('select[aria-label="Add an option of rc-solve"] option[disabled]').all_text_contents()
    ok('  ', any(name.startswith('Yield stress (not with “Hardness”): ') for name in names)
       and any(name.startswith('Time (needs “Relaxation”, which does not go with ') for name in names), str(names))
    page.locator('[data-name=hardness] input').first.fill('6GPa')
    page.locator('#known [data-name=yield] input').fill('300kg')
    page.click('#judge')
    page.wait_for_selector('#verdicts .failed')
    ok('a study that fails says why below the result', '300kg' in page.inner_text('#verdicts'), page.inner_text('#verdicts'))
    page.locator('#known [data-name=yield] input').fill('')
    page.click('details:has(> summary code:text("rc-wear")) > button:text-is("Remove")')
    page.locator('#known [data-name=mu] input').fill('0.25')
    page.locator('#known [data-name=yield] input').fill('310MPa')
    page.click('#accuracy summary')
    page.fill('#noise', '3nm')
    with page.expect_download() as download:
        page.click('#save [name="report.html"]')
    download.value.save_as(place('effects.html'))
    report, line = open(place('effects.html')).read(), page.inner_text('#made code')
    ok('the saved report has the data of the effects and the noise', '--mu 0.25' in report and '310 MPa' in report
       and 'Noise of 3 nm' in report, line)
    ok('  and its command is listed as it ran', line.startswith('rc-report ') and '--coefficient 1e-6mm3/Nm --distance 1m' in line
       and '--mu 0.25' in line and '--yield 310MPa' in line and '--noise 3nm' in line, line)
    page.locator('#known [data-name=yield] input').fill('')
    page.fill('#noise', '5nm')
    page.click('#accuracy summary')


def queue(page):
    """Files and studies wait for each other and say so; during a run they are made of the result that is shown."""
    page.check('#views input[value=Map]', force=True)
    shown(page, 'Map')
    page.evaluate('() => { delete document.body.dataset.judged; window.noted = []; new MutationObserver(() => noted.push($("job").textContent)).observe($("job"), {childList: true}); }')
    with page.expect_download() as download:
        page.evaluate("""() => {
            document.querySelector('#judge').click();
            setTimeout(() => document.querySelector('#save [name="report.html"]').click(), 50);
        }""")
    noted = page.evaluate('() => noted')
    ok('the report page waits for the verdicts, and says so', 'rc-report waits until rc-scene has ended.' in noted
       and page.evaluate('() => Boolean(document.body.dataset.judged)') and noted[-1] == 'report.html is saved.', ' | '.join(noted))
    download.value.save_as(place('waited.html'))
    load = page.locator('details:has(code:text("rc-solve")) input').first
    before = load.input_value()
    load.fill('1N:60N:4000')
    page.keyboard.press('Control+Enter')
    page.wait_for_selector('#said:has-text("case 2")')
    with page.expect_download() as download:
        page.click('#save [name="pressure-map.png"]')
    download.value.save_as(place('during.png'))
    page.wait_for_selector('#job:text-is("pressure-map.png is saved.")')
    ok('during a run the result that is shown is saved', page.get_attribute('body', 'data-run').endswith('running')
       and open(place('during.png'), 'rb').read(4) == b'\x89PNG', page.inner_text('#job'))
    page.keyboard.press('Escape')
    page.wait_for_selector('body[data-run$=stopped]', state='attached')
    load.fill(before)
    page.keyboard.press('Control+Enter')
    page.wait_for_selector('body[data-run$=done]', state='attached')
    shown(page, 'Map pressure')


def headlines(page):
    """Numbers begins with the figures of the step whose result is shown, which is the added one, and has those of the others."""
    def rows(selector):
        return dict(line.split('\t') for line in page.inner_text(selector).splitlines() if '\t' in line)

    def report(tool):
        text = page.evaluate('''async tool => (await fetch(address('file', {run: run.number, of: 'report',
            step: run.steps.findIndex(step => step.tool === tool)}))).text()''', tool)
        return dict(zip(*(line.split('\t') for line in text.splitlines())))

    page.locator('details:has(code:text("rc-solve")) input').first.fill('1N')
    for tool, title, channel, figures in (
            ('rc-heat', 'Flash temperatures', 'temperature-1', (('Largest temperature', 'max_temperature/K', 'K'), ('Heat', 'heat_power/W', 'W'))),
            ('rc-slip', 'Friction', 'traction-x', (('Part of the contact that sticks', 'stick_fraction', ''),
                                                   ('Largest tangential force', 'limit/N', 'N')))):
        page.check('#views input[value=Map]', force=True)
        page.select_option('#add', value=tool)
        page.keyboard.press('Control+Enter')
        shown(page, 'Map ' + channel)
        ok('after %s its own result is shown' % title, 'after ' + tool in page.locator('#channel option:checked').inner_text(),
           page.locator('#channel option:checked').inner_text())
        page.check('#views input[value=Numbers]', force=True)
        shown(page, 'Numbers')
        page.wait_for_selector('#numbers > table')
        first, told = rows('#numbers > table'), report(tool)
        heads = page.locator('#numbers h3').all_text_contents()
        ok('  Numbers begins with it', heads and heads[0] == '%s (%s)' % (title, tool) and len(first) <= 10, ', '.join(heads))
        for name, key, unit in figures:
            value = first.get(name, 'nan').split(' ')
            power = {'': 1, 'm': 1e-3, 'k': 1e3}[value[1][:-len(unit)] if unit else '']
            ok('  %s is that of the report' % name, abs(float(value[0]) * power / float(told[key]) - 1) < 1e-3, ' '.join(value))
        ok('  the figures of the contact follow', 'Press (rc-solve)' in heads[1:] and 'Contact area' in rows('#numbers > div:has(> h3:text("Press")) table'))
        picture(page, 'numbers-' + tool)
    ok('  those of heat stay too', 'Flash temperatures (rc-heat)' in heads[1:], ', '.join(heads))
    for tool in ('rc-slip', 'rc-heat'):
        page.click('details:has(> summary code:text("%s")) > button:text-is("Remove")' % tool)
    page.check('#views input[value=Map]', force=True)


def remove(page):
    """A run is selected in the list and removed."""
    page.check('#views input[value=Map]', force=True)
    names = page.locator('#runs option').all_text_contents()
    page.select_option('#runs', label=names[0])
    page.wait_for_selector('body[data-run^="1 "]', state='attached')
    page.click('#remove')
    page.wait_for_function('count => document.querySelectorAll("#runs option").length === count', arg=len(names) - 1)
    ok('a run is selected and removed', names[0] not in page.locator('#runs option').all_text_contents())


def crop(page):
    drop(page, 'rough-steel.x3p')
    page.check('#views input[value=Map]', force=True)
    shown(page, 'Map height')
    for _ in range(3):
        page.click('#dials button:text("+")')
    page.click('#dials button:has-text("Crop to this part")')
    page.wait_for_selector('.command code:has-text("rc-pick --crop")')
    ok('the visible part becomes the step Crop', True, page.inner_text('.command code:has-text("rc-pick --crop")'))
    picture(page, 'crop')


def large(page):
    """2048 x 2048 nodes: seconds, milliseconds, and a contact of one node."""
    page.set_input_files('#file', place('node.rcg'))
    page.wait_for_selector('#at:has-text("2048 × 2048 nodes, 0 Pa to 1 GPa")')
    count = '''() => {
        const c = document.querySelector('#map'), d = new Uint32Array(c.getContext('2d').getImageData(12, 12, c.width - 140, c.height - 70).data.buffer);
        return d.filter(pixel => pixel === map.table[255]).length;
    }'''
    seen = page.evaluate(count)
    ok('one node in contact of 2048 x 2048 is visible', 4 <= seen <= 16, '%d pixels' % seen)
    picture(page, 'node')
    page.evaluate("() => map.show(map.frame, 'mean', () => map.table)")
    ok('  as a mean it would not be', page.evaluate(count) == 0)
    page.set_input_files('#file', place('big.x3p'))
    page.wait_for_selector('#source:has-text("big.x3p")')
    page.wait_for_selector('#channel option:has-text("rc-import")', state='attached')
    shown(page, 'Map height')
    page.locator('details:has(code:text("rc-solve")) input').first.fill('60N')
    page.set_default_timeout(180000)
    began = time.time()
    page.keyboard.press('Control+Enter')
    shown(page, 'Map pressure')
    ok('2048 x 2048: Run to map', time.time() - began < 120, '%.1f s' % (time.time() - began))
    picture(page, 'large')
    times = []
    box = page.locator('#map').bounding_box()
    page.mouse.move(box['x'] + 300, box['y'] + 300)
    for k in range(20):
        page.mouse.wheel(0, -200 if k < 10 else 200)
        page.wait_for_timeout(60)
        times.append(float(page.get_attribute('#map', 'data-milliseconds')))
    ok('2048 x 2048: a zoom step', max(times) < 500, 'median %.0f ms, largest %.0f ms' % (sorted(times)[10], max(times)))


with sync_playwright() as playwright:
    wide = Browser(playwright)
    page = wide.open()
    for check in (by_keyboard, sections, words, errors, headlines, effects, queue, accuracy, remove, crop, spikes, compare, large):
        try:
            check(page)
        except Exception as e:
            ok(check.__name__, False, str(e)[:600])
            picture(page, 'failed-' + check.__name__)
    page.close()
    for name, more in (('narrow', {'viewport': {'width': 420, 'height': 900}}), ('dark', {'color_scheme': 'dark'})):
        other = Browser(playwright, **more)
        page = other.open()
        page.click('#sample')
        shown(page, 'Map height')
        page.keyboard.press('Control+Enter')
        shown(page, 'Map pressure')
        picture(page, name)
        page.screenshot(path=place('shots/%s-whole.png' % name), full_page=True)
        ok('%s: nothing is wider than the window' % name, page.evaluate('() => document.documentElement.scrollWidth <= innerWidth'))
        wide.errors += other.errors
    wrong = [error for error in wide.errors if 'status of 422' not in error]  # that of a study which must fail
    ok('the browser reports no error', not wrong and len(wide.errors) < 2, '; '.join(wide.errors)[:500])
