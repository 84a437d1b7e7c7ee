# Prints an apt source entry for the backports of a release, made from the entry that the machine already uses for
# the release itself, so that the mirror, its keys and its options are the machine's own.
#
#   awk -v release=bookworm -v distribution=debian -f backports.awk /etc/apt/sources.list /etc/apt/sources.list.d/*
#
# Reads both formats of sources.list(5): one-line entries (*.list) and stanzas (*.sources). The result has the format of
# the entry it was made from. An entry qualifies if it is enabled, serves binary packages over something other than a
# disc, and names exactly this release as a suite with the component `main`; the hosts of security updates name
# `RELEASE-security` instead and so never qualify. Repositories of third parties often do qualify, so the mirror of the
# distribution is told from them by what only it has: the suite `RELEASE-updates` at the same address, else an
# address that ends in the name of the distribution; among equals the first wins.
#
# Prints nothing if no entry qualifies, or if one for the backports is there already.

BEGIN { backports = release "-backports" }

FNR == 1 { end_stanza(); stanzas = FILENAME ~ /\.sources$/ }

{ sub(/\r$/, "") }

stanzas && /^[ \t]*#/ { next }
stanzas && /^[ \t]*$/ { end_stanza(); next }
stanzas { stanza_line($0); next }

/^[ \t]*deb[ \t]/ { one_line($0) }

END {
    end_stanza()
    if (present) exit
    best = 0
    for (i = 1; i <= entries; i++) {
        score = 1
        if (address[i] ~ ("/" distribution "/?$")) score += 1
        if ((address[i], release "-updates") in served) score += 2
        if (score > best) { best = score; chosen = i }
    }
    if (best) printf "%s", text[chosen]
}

# One entry for one address: `suites` and `components` are lists between blanks, `entry` is what to print for it.
function candidate(uri, suites, components, entry,    i, n, suite) {
    sub(/\/+$/, "", uri)
    n = split(suites, suite, /[ \t]+/)
    for (i = 1; i <= n; i++) {
        served[uri, suite[i]] = 1
        if (suite[i] == backports) present = 1
    }
    if (!has(suites, release) || !has(components, "main") || uri ~ /^cdrom:/) return
    entries++
    address[entries] = uri
    text[entries] = entry
}

function has(list, word) { return index(" " list " ", " " word " ") > 0 }

# `deb [option=value …] uri suite component …`
function one_line(line,    options, n, field, components, i) {
    sub(/[ \t]+#.*$/, "", line)
    sub(/^[ \t]*deb[ \t]+/, "", line)
    options = ""
    if (match(line, /^\[[^]]*\][ \t]*/)) {
        options = substr(line, 1, RLENGTH)
        sub(/[ \t]*$/, " ", options)
        line = substr(line, RLENGTH + 1)
    }
    # The name of a disc has blanks in it: `cdrom:[Debian 12 …]/`.
    if (line ~ /^cdrom:/) return
    n = split(line, field, /[ \t]+/)
    components = ""
    for (i = 3; i <= n; i++) components = components " " field[i]
    candidate(field[1], field[2], components, "deb " options field[1] " " backports " main\n")
}

# A stanza is kept as it stands, but for its types, suites and components. A line that starts with a blank continues a
# field.
function stanza_line(line,    colon) {
    if (line ~ /^[ \t]/) {
        if (name == "") return
        value[name] = value[name] " " line
    } else {
        colon = index(line, ":")
        name = tolower(substr(line, 1, colon - 1))
        value[name] = substr(line, colon + 1)
    }
    if (name !~ /^(types|suites|components)$/) kept = kept line "\n"
}

function end_stanza(    types, uris, suites, components, n, uri, i, entry) {
    types = words(value["types"]); uris = words(value["uris"])
    suites = words(value["suites"]); components = words(value["components"])
    entry = "Types: deb\n" kept "Suites: " backports "\nComponents: main\n"
    if (has(types, "deb") && tolower(words(value["enabled"])) !~ /^(no|false|without|off|disable|0)$/) {
        n = split(uris, uri, " ")
        for (i = 1; i <= n; i++) candidate(uri[i], suites, components, entry)
    }
    split("", value); name = ""; kept = ""
}

# Without blanks at the ends, and with single ones between.
function words(list) {
    gsub(/[ \t]+/, " ", list)
    sub(/^ /, "", list)
    sub(/ $/, "", list)
    return list
}
