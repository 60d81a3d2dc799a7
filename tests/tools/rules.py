# SPDX-License-Identifier: GPL-3.0-or-later
"""
The law of the rules between options, for every tool that is named. `--completions json` has the rules, and each
one is broken here on a command line of its own:

    against   the option with each of the others is refused with status 2, and the message names both
    needs     the option without any of the others is refused with status 2, and the message names all
    one_of    none of the options, and two of them, are refused with status 2, and the message names all

The same rules stand in --help at their options, in the words of the message. In the manual the paragraph of one
of two options names the other, but for rc-solve: its effects have pages of their own, which pipe_help compares
with the rules. Each option of a rule exists.

    rules.py FOLDER TOOL...        FOLDER has the pages of the manual

The last line has the counts.
"""
import collections
import json
import os
import re
import subprocess
import sys

environment = dict(os.environ, LC_ALL='C')
counts = collections.Counter(tools=0, against=0, needs=0, one_of=0, wrong=0)


def run(*command):
    r = subprocess.run(command, capture_output=True, env=environment, stdin=subprocess.DEVNULL, timeout=60)
    return r.returncode, r.stdout.decode(), r.stderr.decode()


def wrong(*words):
    counts['wrong'] += 1
    print('WRONG:', *words)


def shown(option):
    name = ('-' if len(option['name']) == 1 else '--') + option['name']
    return name if option['word'] is None else '%s %s' % (name, option['word'])


def number(row):
    least, most = row['least'], row['most']
    if least is None:
        return 1 if most is None else most
    if most is None:
        return least + 1
    return most


def value(row, word):
    """An argument that the option takes, or None: with this word, if it is not None."""
    kind = row['type']
    if kind == 'numbers' and word == 'LIST':
        return '%.17g:%.17g:2' % (number(row), number(row))
    if kind in ('number', 'count', 'numbers', 'step') and (word is None or word == row['argument']):
        return row['words'][0] if kind == 'step' and row['words'] else None if row['argument'] is None else '%.17g' % number(row)
    if word is not None:
        return word
    if kind == 'flag' or kind == 'step' and row['argument'] is None:
        return None
    return row['words'][0] if row['words'] else 'x'


class Tool:
    def __init__(self, name):
        status, text, _ = run(name, '--completions', 'json')
        table = json.loads(text)
        self.name, self.rows = name, {row['name']: row for row in table['options']}
        self.help = run(name, '--help')[1]
        with open(os.path.join(sys.argv[1], name + '.1'), encoding='utf-8') as page:
            items = re.split(r'^\.It ', page.read(), flags=re.M)
        self.items = {}
        for item in items:
            for option in re.findall(r'(?:^Fl|,|\|)(?: Fl)? -?([A-Za-z0-9-]+)', item.split('\n')[0]):
                self.items[option] = self.items.get(option, '') + item.partition('\n')[2]

    def words(self, option):
        row = self.rows[option['name']]
        got = value(row, option['word'])
        name = shown(dict(option, word=None))
        return [name] if got is None else [name + '=' + got] if name.startswith('--') else [name, got]

    def line(self, options):
        return [word for option in options for word in self.words(option)]

    def with_needs(self, options, own=None):
        """The options, and those that they need, the first of each rule; not those that `own` needs."""
        options = list(options)
        for option in options:
            if option == own:
                continue
            for rule in self.rows[option['name']]['needs']:
                if rule['words'] and option['word'] not in rule['words']:
                    continue
                if not any(other in options or dict(other, word=None) in [dict(o, word=None) for o in options]
                           and other['word'] is None for other in rule['options']):
                    options.append(rule['options'][0])
        return options

    def without(self, options):
        """Options with words that they may have by default: the same with another word."""
        words = {}
        for option in options:
            others = [word for word in self.rows[option['name']]['words'] if dict(option, word=word) not in options]
            if option['word'] is not None and others:
                words[option['name']] = others[0]
        return [{'name': name, 'word': word} for name, word in words.items()]

    def refused(self, kind, options, named):
        counts[kind] += 1
        line = self.line(options)
        status, _, err = run(self.name, *line)
        missing = [name for name in named if not re.search(re.escape(name) + r'(?![a-z0-9-])', err)]
        if status != 2 or missing:
            wrong(self.name, *line, '| status %d | %s | not named: %s' % (status, err.strip(), ' '.join(missing)))

    def helped(self, row):
        """The rules stand below the option in --help."""
        entry = re.search(r'^  --%s\b(?!-).*?(?=^  -|^\S|^$)' % re.escape(row['name']), self.help, re.M | re.S)
        flat = re.sub(r'\s+', ' ', entry.group(0)) if entry else ''
        if row['rules'] and not flat.rstrip().endswith(row['rules']):
            wrong(self.name, row['name'], '| --help does not end with:', row['rules'])
        for kind, phrase in (('against', 'not with'), ('needs', 'needs')):
            for rule in row[kind]:
                for other in rule['options']:
                    if not re.search(phrase + r'[^;]*' + re.escape(shown(other)), row['rules']):
                        wrong(self.name, row['name'], '| the rules do not name', shown(other), ':', row['rules'])

    def paged(self, option, other):
        def named(one, two):
            return re.search(r'^\.Fl (.* )?-?%s(?![A-Za-z0-9-])' % re.escape(two), self.items.get(one, ''), re.M)
        if self.name != 'rc-solve' and option != other and not named(option, other) and not named(other, option):
            wrong(self.name, option, other, '| the manual names neither at the other')

    def walk(self):
        counts['tools'] += 1
        demanded = [rule for row in self.rows.values() for rule in row['one_of']]
        for row in self.rows.values():
            self.helped(row)
            for kind in ('against', 'needs', 'one_of'):
                for rule in row[kind]:
                    for other in rule['options']:
                        if other['name'] not in self.rows:
                            wrong(self.name, row['name'], kind, other['name'], '| no such option')
                        if kind != 'one_of':
                            self.paged(row['name'], other['name'])
            for rule in row['against']:
                for word in rule['words'] or [None]:
                    for other in rule['options']:
                        both = [{'name': row['name'], 'word': word}, other]
                        self.refused('against', both, map(shown, both))
            for k, rule in enumerate(row['needs']):
                for word in rule['words'] or [None]:
                    own = {'name': row['name'], 'word': word}
                    before = [r['options'][0] for r in row['needs'][:k]]
                    line = self.with_needs([own] + before, own)
                    line += self.without(rule['options'])
                    self.refused('needs', line, [shown(own)] + [shown(o) for o in rule['options']])
            for rule in row['one_of']:
                names = [shown(o) for o in rule['options']]
                rest = [r['options'][0] for r in demanded if r is not rule]
                self.refused('one_of', self.with_needs(rest), names)
                for pair in zip(rule['options'], rule['options'][1:]):
                    self.refused('one_of', self.with_needs(list(pair) + rest), names)


for name in sys.argv[2:]:
    Tool(name).walk()
print(' '.join('%s %d' % pair for pair in counts.items()))
sys.exit(counts['wrong'] != 0)
