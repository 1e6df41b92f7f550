"""Seeded mutations of bytes, texts and databases."""

import json
import re
import sqlite3
import struct

WORDS = (0, 1, 2, 3, 0x7F, 0x80, 0xFF, 0x100, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1 << 40, (1 << 64) - 1)
NUMBERS = ("0", "-1", "1", "2", "1e400", "-1e400", "nan", "inf", "1e-320", "2147483648", "4294967296", "9" * 40, "0x10", "1,5", "",
           "18446744073709551616", "-0.0", "90.00001", "180.5", "24", "255", "1e9")
TEXTS = ("\x1b[31mred", "\x00", "\x07", "\u202e", "\x9b2J", "../../../../etc/passwd", "%s%n%x", "A" * 5000, "<!--", "]]>", "&#27;",
         "&lt;", "\\u001b]0;x\\u0007", "{z}", "{q}", "${z}", "\r\n", "\ufffe", "\ud7ff", "'; DROP TABLE tiles; --", '"', "\\", "[" * 3000)
VALUES = (None, -1, 0, 1, 1 << 31, (1 << 63) - 1, -(1 << 63), 1e308, 1e-320, 0.5, "", "text", "\x1b[31m", b"", b"\0" * 9, "9e999",
          "A" * 10000)
HEAD_BYTES = 600  # headers, directories and their ends are where most of a format is


def place(rng, size):
    """Near the start or the end in two of three cases."""
    if size == 0:
        return 0
    where = rng.randrange(3)
    near = rng.randrange(min(size, HEAD_BYTES))
    return near if where == 0 else size - 1 - near if where == 1 else rng.randrange(size)


def mutate_bytes(rng, data):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 4, 16))):
        at, kind, length = place(rng, len(data)), rng.randrange(9), rng.choice((1, 2, 8, 64, 1000))
        if kind == 0 and data:
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 1 and data:
            data[at] = rng.choice((0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)))
        elif kind <= 3:
            code = rng.choice("HIQ")
            word = rng.choice(WORDS) & ((1 << 8 * struct.calcsize(code)) - 1)
            packed = struct.pack(rng.choice("<>") + code, word)
            data[at:at + len(packed)] = packed
        elif kind == 4:
            del data[at:at + length]
        elif kind == 5:
            data[at:at] = rng.randbytes(length)
        elif kind == 6:
            data[at:at + length] = bytes(len(data[at:at + length]))
        elif kind == 7:
            start = place(rng, len(data))
            data[at:at] = data[start:start + length]
        else:
            del data[at:]
    return bytes(data)


def mutate_characters(rng, text):
    for _ in range(rng.choice((1, 1, 1, 2))):
        numbers, strings = (list(re.finditer(pattern, text)) for pattern in (r"-?\d[\d.e+-]*", r"[A-Za-z_:]{2,}"))
        kind = rng.randrange(8)
        at = rng.randrange(len(text) + 1)
        if kind >= 5 and numbers:
            text = replaced(text, rng.choice(numbers).span(), rng.choice(NUMBERS))
        elif kind <= 1 and strings:
            text = replaced(text, rng.choice(strings).span(), rng.choice(TEXTS))
        elif kind == 2 and len(strings) > 1:
            one, other = sorted((m.span() for m in rng.sample(strings, 2)), reverse=True)
            words = text[slice(*one)], text[slice(*other)]
            text = replaced(replaced(text, one, words[1]), other, words[0])
        elif kind == 3:
            text = replaced(text, (at, at + rng.choice((1, 5, 40, 400))), "")
        else:
            text = replaced(text, (at, at), rng.choice((*TEXTS, text[at:at + rng.choice((10, 200))])))
    return text


def replaced(text, span, by):
    return text[:span[0]] + by + text[span[1]:]


def nodes_of(value):
    """Pairs (container, key) of every node of a JSON document."""
    found, waiting = [], [value]
    while waiting:
        one = waiting.pop()
        keys = list(one) if isinstance(one, dict) else range(len(one)) if isinstance(one, list) else ()
        found += [(one, key) for key in keys]
        waiting += [one[key] for key in keys]
    return found


def mutate_json(rng, text):
    """Changes nodes, so that the document stays JSON."""
    document = json.loads(text)
    others = (None, True, -1, 0, 1e308, -1e308, 1 << 70, "", "\x1b[2J", "A" * 5000, [], {}, [[]] * 50, {"a": {"a": {}}}, 0.1, 25, -91.0)
    for _ in range(rng.choice((1, 1, 2, 3))):
        nodes = nodes_of(document)
        if not nodes:
            break
        (container, key), (giver, given) = rng.choice(nodes), rng.choice(nodes)
        kind = rng.randrange(4)
        if kind == 0:
            del container[key]
        elif kind == 1 and json.dumps(giver[given]).find("1" * 9999) < 0:
            container[key] = json.loads(json.dumps(giver[given]))
        elif kind == 2 and isinstance(container, list):
            container[key:key] = json.loads(json.dumps([container[key]])) * rng.choice((1, 50))
        else:
            container[key] = rng.choice(others)
    return json.dumps(document)


def mutate_text(rng, name, data):
    if rng.randrange(6) == 0:
        return mutate_bytes(rng, data)
    text = data.decode("utf-8")
    if name.endswith(("json", "gltf")) and rng.randrange(2) == 0:
        return mutate_json(rng, text).encode("utf-8", "replace")
    return mutate_characters(rng, text).encode("utf-8", "replace")


def mutate_database(rng, path):
    """Statements that SQLite refuses change nothing."""
    with sqlite3.connect(path, isolation_level=None) as base:
        base.execute("PRAGMA writable_schema = ON")
        tables = [name for (name,) in base.execute("SELECT name FROM sqlite_master WHERE type IN ('table', 'view')")]
        for _ in range(rng.choice((1, 1, 2, 3))):
            try:
                mutate_table(rng, base, rng.choice(tables))
            except sqlite3.Error:
                pass
    base.close()


def mutate_table(rng, base, table):
    columns = [row[1] for row in base.execute(f'PRAGMA table_info("{table}")')]
    rows = [rowid for (rowid,) in base.execute(f'SELECT rowid FROM "{table}"')]
    if not columns or not rows:
        return
    column = rng.choice(columns)
    row = f"rowid IN ({', '.join(map(str, rng.sample(rows, min(len(rows), rng.choice((1, 1, 1000))))))})"
    kind = rng.randrange(8)
    if kind <= 2:
        base.execute(f'UPDATE OR REPLACE "{table}" SET "{column}" = ? WHERE {row}', (rng.choice(VALUES),))
    elif kind == 3:
        for rowid, value in base.execute(f'SELECT rowid, "{column}" FROM "{table}"').fetchall():
            if isinstance(value, bytes):
                base.execute(f'UPDATE "{table}" SET "{column}" = ? WHERE rowid = ?', (mutate_bytes(rng, value), rowid))
            elif isinstance(value, str):
                base.execute(f'UPDATE "{table}" SET "{column}" = ? WHERE rowid = ?', (mutate_characters(rng, value), rowid))
            elif value is not None:
                base.execute(f'UPDATE "{table}" SET "{column}" = {rng.choice((-1, 2, 1000))} * "{column}"')
    elif kind == 4:
        base.execute(f'DELETE FROM "{table}" WHERE {row}')
    elif kind == 5:
        base.execute(f'ALTER TABLE "{table}" DROP COLUMN "{column}"')
    elif kind == 6:
        base.execute(f'ALTER TABLE "{table}" RENAME COLUMN "{column}" TO "other\x1b"')
    else:
        base.execute(f'DROP TABLE "{table}"')
