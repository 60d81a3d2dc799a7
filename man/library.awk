# awk -v source=DIR -v soname=NAME -v out=FILE -f library.awk FRAME: writes libcontact(3) to FILE. The frame is the page, with lines
#   @head FILE       the comment at the top of a header
#   @body FILE       the rest of the header: its titles, comments, structs, constants and functions
#   @program FILE    a program, as a display
# and @soname@. Files are relative to `source`.

# ---- text ----

# Escapes what mdoc would take for a command; `name` is italic.
function plain(s) {
    while (match(s, /`[^`]+`/))
        s = substr(s, 1, RSTART - 1) "\\fI" substr(s, RSTART + 1, RLENGTH - 2) "\\fR" substr(s, RSTART + RLENGTH)
    return s ~ /^[.']/ ? "\\\&" s : s
}

# Escapes a line of a display, whose minus signs and quotes can be copied.
function code(s) {
    gsub(/\\/, "\\e", s)
    gsub(/-/, "\\-", s)
    gsub(/'/, "\\(aq", s)
    return s ~ /^\./ ? "\\\&" s : s
}

# Prints a line; no paragraph begins below a title.
function say(s) {
    if (s != ".Pp" || !titled) print s >out
    titled = s ~ /^\.S[sh] /
}

# Prints sentences, each on lines of its own.
function sentences(s,    n, word, k, line, bare) {
    gsub(/\\/, "\\e", s)
    n = split(s, word, " ")
    for (k = 1; k <= n; k++) {
        if (line != "" && length(line " " word[k]) > 72) {
            say(plain(line))
            line = ""
        }
        line = line == "" ? word[k] : line " " word[k]
        bare = word[k]
        sub(/^\(/, "", bare)
        if (k < n && bare ~ /^([A-Z]|eq|al|Phys|Soc|Proc|Appl|Surf|Mech|Topogr|Condens)\.$/) line = line "\\&"
        else if (bare ~ /[A-Za-z0-9)`"'.][.?!]$/) {
            say(plain(line))
            line = ""
        }
    }
    if (line != "") say(plain(line))
}

# ---- comments ----

# Prints a comment of several paragraphs, lines of which may be indented: displays.
function paragraphs(n, line,    k, text, open, blank) {
    for (k = 1; k <= n; k++) {
        if (line[k] ~ /^    /) {
            if (text != "") { sentences(text); text = "" }
            if (!open) { say(".Bd -literal"); open = 1 } else while (blank-- > 0) say("")
            blank = 0
            say(code(substr(line[k], 5)))
            continue
        }
        if (line[k] == "") {
            if (text != "") { sentences(text); text = "" }
            blank++
            continue
        }
        if (open) { say(".Ed"); open = 0 }
        if (blank > 0 && some) say(".Pp")
        blank = 0
        some = 1
        if (line[k] ~ /^  - /) { # an entry of a list
            if (text != "") { sentences(text); text = "" }
            if (!some_list) { say(".Bl -bullet -compact"); some_list = 1 }
            say(".It")
            text = substr(line[k], 5)
            while (k < n && line[k + 1] ~ /^    [^ ]/) text = text " " substr(line[++k], 5)
            sentences(text)
            text = ""
            if (line[k + 1] !~ /^  - /) { say(".El"); some_list = 0 }
            continue
        }
        text = text == "" ? line[k] : text " " line[k]
    }
    if (text != "") sentences(text)
    if (open) say(".Ed")
}

# Reads the rest of a comment whose first line is s: its lines, without the stars, in said[1 .. lines].
function comment(s,    last) {
    lines = 0
    sub(/^ *\/\*\*? ?/, "", s)
    while (1) {
        last = s ~ /\*\/ *$/
        sub(/ *\*\/ *$/, "", s)
        if (!(s == "" && (lines == 0 || last))) said[++lines] = s
        if (last || (getline s <file) <= 0) return
        sub(/^ *\*( |$)/, "", s)
    }
}

# ---- lists of functions ----

function close_list() {
    if (listed) say(".El")
    listed = 0
}

# The text of the functions before it.
function describe() {
    if (!waiting) return
    waiting = 0
    if (pending > 0) paragraphs_of_item()
    else if (frees) say("Frees it.")
    pending = frees = 0
}
function paragraphs_of_item(    k, kept) {
    some = 0
    paragraphs(pending, held)
}

# Heads an item by a declaration without its semicolon.
function item(s,    type, name, args, n, arg, k, out) {
    if (!listed) say(".Bl -tag -width Ds")
    listed = 1
    sub(/__attribute__.*/, "", s)
    gsub(/ +/, " ", s)
    sub(/ $/, "", s)
    if (s !~ /\(/) { # an object
        say(".It Vt \"" s "\"")
        return
    }
    name = s
    sub(/\(.*/, "", name)
    args = substr(s, length(name) + 2)
    sub(/\) *$/, "", args)
    type = name
    sub(/[A-Za-z_0-9]+$/, "", type)
    name = substr(name, length(type) + 1)
    sub(/ $/, "", type)
    out = (type == "" ? ".It Fn " : ".It Ft \"" type "\" Fn ") name
    n = split(args, arg, /, /)
    for (k = 1; k <= n; k++) out = out " \"" arg[k] "\""
    say(out)
    frees = name ~ /_free$/
}

# ---- structs and enums ----

# A comment above a member, within the width of a page.
function above(s,    n, word, k, line) {
    n = split(s, word, " ")
    line = "    /*"
    for (k = 1; k <= n; k++) {
        if (length(line " " word[k]) > wide - (k == n ? 3 : 0)) {
            say(code(line))
            line = "     *"
        }
        line = line " " word[k]
    }
    say(code(line " */"))
}

# Prints the definition that begins with this line. Comments at the ends of lines move above them if one of
# them is too long for the page.
function definition(s,    n, line, k, long, text, at) {
    while (1) {
        line[++n] = s
        if (s ~ /^\}/) break
        if ((getline s <file) <= 0) return
    }
    for (k = 2; k < n; k++) long = long || (length(line[k]) > wide && line[k] !~ /^ *(\/\*| \*)/)
    say(".Bd -literal")
    for (k = 1; k <= n; k++) {
        at = index(line[k], " /*")
        if (line[k] ~ /^ *\/\*/) {
            text = line[k]
            sub(/^ *\/\* ?/, "", text)
            while (text !~ /\*\/$/) {
                line[++k] = line[k]
                sub(/^ *\* ?/, "", line[k])
                text = text " " line[k]
            }
            sub(/ *\*\/$/, "", text)
            above(text)
        } else if (long && k > 1 && k < n && at > 0) {
            text = substr(line[k], at + 3)
            sub(/ *\*\/.*/, "", text)
            above(text)
            text = substr(line[k], 1, at)
            sub(/ +$/, "", text)
            say(code(text))
        } else say(code(line[k]))
    }
    say(".Ed")
}

# ---- headers ----

function head(    s, k) {
    getline s <file
    if (s ~ /SPDX/) getline s <file
    comment(s)
    some = 0
    paragraphs(lines, said)
    close(file)
}

# A comment that is not followed by a declaration is a paragraph.
function paragraph() {
    if (pending == 0) return
    close_list()
    say(".Pp")
    some = 0
    paragraphs(pending, held)
    pending = 0
}

function body(    s, k, more, first) {
    getline s <file
    if (s ~ /SPDX/) getline s <file
    comment(s) # the head
    while ((getline s <file) > 0) {
        if (s ~ /^\/\* ---- /) {
            describe()
            paragraph()
            close_list()
            gsub(/^\/\* ---- | ---- \*\/$/, "", s)
            say(".Ss " toupper(substr(s, 1, 1)) substr(s, 2))
        } else if (s ~ /^\/\*/) {
            describe()
            comment(s)
            paragraph()
            pending = lines
            for (k = 1; k <= lines; k++) held[k] = said[k]
        } else if (s ~ /^#define RC_[A-Z_]+ /) {
            describe()
            paragraph()
            close_list()
            say(".Bd -literal")
            say(code(s))
            say(".Ed")
        } else if (s ~ /^#define RC_[A-Z_]+\(/ && s !~ /RC_KIND_OF/) {
            sub(/^#define /, "", s)
            sub(/\).*/, ")", s)
            item(s)
            waiting = 1
        } else if (s ~ /^(struct|enum).*\{/) {
            describe()
            paragraph()
            close_list()
            definition(s)
        } else if (s ~ /^struct rc_[a-z]+; .*\*\//) { # handles
            describe()
            paragraph()
            close_list()
            say(".Bd -literal")
            for (first = 1; s ~ /^struct/; first = 0) {
                gsub(/ +\*\/$/, " */", s)
                say(code(s))
                if ((getline s <file) <= 0) break
            }
            say(".Ed")
        } else if (s ~ /^(RC_API|static inline) /) {
            while (s !~ /;/ && s !~ /\{$/ && (getline more <file) > 0) {
                if (more ~ /^#/) continue
                sub(/^ +/, more ~ /^[a-z]/ ? "" : " ", more)
                s = s (s ~ /[*(]$/ ? "" : " ") more
                if (more == "{") break
            }
            sub(/^(RC_API|static inline) /, "", s)
            gsub(/\( +/, "(", s)
            sub(/ *\{.*/, "", s)
            sub(/;.*/, "", s)
            if (s ~ /_free\(/) describe()
            item(s)
            waiting = 1
        } else if (s == "") {
            describe()
            paragraph()
        }
    }
    describe()
    paragraph()
    close_list()
    close(file)
}

function program(    s) {
    while ((getline s <file) > 0)
        if (!(s ~ /^\/\*/ && !shown)) {
            if (!shown) say(".Bd -literal")
            shown = 1
            say(code(s))
        }
    say(".Ed")
    shown = 0
    close(file)
}

BEGIN {
    wide = 73
    if (out == "") out = "/dev/stdout"
}
{ file = source "/" $2 }
/^@(head|body|program) / && (getline first <file) <= 0 {
    print file ": cannot be read" >"/dev/stderr"
    exit 1
}
/^@(head|body|program) / { close(file) }
/^@head / { head(); next }
/^@body / { body(); next }
/^@program / { program(); next }
{ gsub(/@soname@/, soname); say($0) }
