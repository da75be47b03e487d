#!/usr/bin/env python3
"""Writes all that follows from the message types, from their .lcm files alone.

  schema.py channels OUTPUT  the C++ header bus/channel_list.h: the channels
  schema.py messages OUTPUT  the C++ header bus/message_schema.h: layouts for the
                             bounded decoder, limits, which texts to clean
  schema.py samples OUTPUT   the C++ header tests/filled_messages.h: one message of
                             each type, for tests and fuzz targets
  schema.py table            the table of channels in docs/messages.md
  schema.py docs FILE        puts that table into FILE, between its two marks

lcmtypes/README.md says what may stand in a .lcm file.
"""
import dataclasses
import pathlib
import re
import sys
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent
# The order of the channels in C++ and in the table: along a request's way.
ORDER = ["map_header_t", "map_tile_t", "map_request_t", "plan_request_t",
         "baseline_t", "advice_t", "verdict_t", "deployed_t", "pose_t",
         "status_t", "config_t", "log_mark_t", "gate_step_t"]
LAYOUT = {"int64_t": "l", "int32_t": "i", "int16_t": "h", "int8_t": "b",
          "byte": "b", "double": "d", "string": "s"}
BITS = {"int64_t": 63, "int32_t": 31, "int16_t": 15, "int8_t": 7, "byte": 8}
STRUCT_TAGS = ["channel", "rate", "size", "from", "to", "stops"]
LINE_BYTES = 63
BEGIN = "<!-- written by lcmtypes/schema.py: begin -->"
END = "<!-- written by lcmtypes/schema.py: end -->"


@dataclasses.dataclass
class Field:
    kind: str
    name: str
    counted_by: str | None
    counts: bool = False         # The length of the lists that follow.
    max: int | None = None       # What the decoder takes at most.
    text: tuple[str, int] | None = None  # How it is cleaned: (form, bytes).


@dataclasses.dataclass
class Message:
    name: str
    tags: dict[str, str]
    fields: list[Field]

    @property
    def channel(self):
        return self.tags["channel"].split()[0]

    @property
    def enumerator(self):
        words = self.channel.removeprefix("TERRA_").split("_")
        return "k" + "".join(word.capitalize() for word in words)


def fail(path, number, what):
    sys.exit(f"{path}:{number}: {what}")


def tags_of(comment, allowed, path, number):
    """The "@name value" lines of a comment; a value may go on in the next line."""
    tags, open_tag = {}, None
    for line in comment:
        found = re.fullmatch(r"@(\w+) (.+)", line)
        if found:
            open_tag = found[1]
            if open_tag not in allowed:
                fail(path, number, f"@{open_tag} is none of @{', @'.join(allowed)}")
            if open_tag in tags:
                fail(path, number, f"@{open_tag} comes twice")
            tags[open_tag] = found[2]
        elif open_tag:
            tags[open_tag] += " " + line
    return tags


def set_tags(field, tags, path, number):
    if "max" in tags:
        if not re.fullmatch(r"\d+", tags["max"]):
            fail(path, number, "@max takes a whole number")
        field.max = int(tags["max"])
    if field.kind == "string":
        form, _, size = tags.get("text", f"line {LINE_BYTES}").partition(" ")
        if form not in ("line", "block") or not size.isdigit():
            fail(path, number, "@text takes `line BYTES` or `block BYTES`")
        field.text = (form, int(size))
    elif "text" in tags:
        fail(path, number, f"@text before {field.kind} {field.name}, which is no string")


def read(path):
    fields, comment, head = [], [], None
    for number, raw in enumerate(path.read_text().splitlines(), 1):
        line = raw.strip()
        if line.startswith("//"):
            comment.append(line[2:].strip())
            continue
        if line.startswith("struct "):
            head = tags_of(comment, STRUCT_TAGS, path, number)
            missing = [tag for tag in STRUCT_TAGS if tag not in head]
            if missing:
                fail(path, number, f"the comment before it lacks @{missing[0]}")
            if line != f"struct {path.stem}":
                fail(path, number, f"a struct that is not named {path.stem}")
        member = re.fullmatch(r"(\w+) (\w+)(?:\[(\w+)\])?;", line)
        if member and head is not None:
            field = Field(member[1], member[2], member[3])
            if field.kind not in LAYOUT:
                fail(path, number, f"no layout for {field.kind}")
            set_tags(field, tags_of(comment, ["max", "text"], path, number), path, number)
            if field.counted_by:
                count = next((f for f in fields if f.name == field.counted_by), None)
                if count is None or count.kind != "int32_t":
                    fail(path, number, f"no int32_t {field.counted_by} before it")
                count.counts = True
                # A layout repeats a field by the last count before it.
                if count is not [f for f in fields if f.counts][-1]:
                    fail(path, number, f"another count stands between {field.counted_by} and it")
            fields.append(field)
        elif line not in ("", "{", "}") and not re.fullmatch(
                r"package terra_msg;|struct \w+|const int\d+_t \w+ = -?\d+;", line):
            fail(path, number, f"cannot read `{line}`: one plain member a line")
        comment = []
    for field in fields:
        if field.max is not None and not field.counts and field.kind != "string":
            sys.exit(f"{path}: @max of {field.name}, which is neither count nor string")
    return Message(path.stem, head, fields)


def all_messages():
    names = sorted(path.stem for path in FOLDER.glob("*.lcm"))
    if names != sorted(ORDER):
        sys.exit(f"{__file__}: ORDER and the .lcm files differ: "
                 f"{', '.join(sorted(set(names) ^ set(ORDER)))}")
    return [read(FOLDER / f"{name}.lcm") for name in ORDER]


# ---- C++ ----

def layout(message):
    text = ""
    for field in message.fields:
        text += "N" if field.counts else LAYOUT[field.kind]
        text += str(field.max) if field.max is not None else ""
        text += "*" if field.counted_by else ""
    return text


def camel(name):
    return "".join(word.capitalize() for word in name.split("_"))


def traits(message):
    limits = "".join(
        f"\n  static constexpr std::int32_t kMax{camel(field.name)} = {field.max};"
        for field in message.fields if field.max is not None)
    visits = "".join(
        f"\n    visit(message.{field.name}, TextForm::k{field.text[0].capitalize()}, "
        f"std::size_t{{{field.text[1]}}});"
        for field in message.fields if field.text)
    body = visits + "\n  " if visits else ""
    names = ("& message", " visit") if visits else ("&", "")
    return f"""
template <>
struct MessageTraits<terra_msg::{message.name}> {{
  static constexpr Channel kChannel = Channel::{message.enumerator};
  static constexpr std::string_view kLayout = "{layout(message)}";{limits}
  template <typename Message, typename Visit>
  static void EachText(Message{names[0]}, Visit{names[1]}) {{{body}}}
}};
"""


HEAD = "// Written by lcmtypes/schema.py from lcmtypes/*.lcm: change those.\n#pragma once\n\n"


def channels(messages):
    enumerators = "\n".join(f"  {message.enumerator}," for message in messages)
    names = "\n".join(f'    "{message.channel}",' for message in messages)
    return f"""{HEAD}#include <array>
#include <string_view>

namespace terra::bus {{

/// Every channel of the project; one message type each.
enum class Channel {{
{enumerators}
}};
inline constexpr int kNumChannels = {len(messages)};

/// Their names without any prefix, in order of Channel.
inline constexpr std::array<std::string_view, kNumChannels> kBaseNames = {{
{names}
}};

}}  // namespace terra::bus
"""


def messages_header(messages):
    includes = "\n".join(f'#include "terra_msg/{message.name}.hpp"' for message in messages)
    types = ",\n".join(f"    terra_msg::{message.name}" for message in messages)
    visits = "\n".join(f"  visit.template operator()<terra_msg::{message.name}>();"
                       for message in messages)
    return f"""{HEAD}#include <cstddef>
#include <cstdint>
#include <string_view>

{includes}

#include "bus/channel_list.h"

namespace terra::bus {{

/// How a text is cleaned before it is sent.
enum class TextForm {{
  kLine,   ///< A name or an error: one line.
  kBlock,  ///< An answer or a configuration: may have many lines.
}};

/// What the .lcm file of a message type says of it: its kChannel, its kLayout
/// for CheckLayout, a kMax... for each count or text with an @max; and
/// EachText(message, visit) calls visit(text or list of texts, form, most bytes)
/// for each of its texts.
template <typename T>
struct MessageTraits;
{"".join(traits(message) for message in messages)}
/// All message types as the arguments of a template, in order of Channel.
template <template <typename...> class List>
using AllMessageTypes = List<
{types}>;

/// Calls visit.operator()<T>() for each message type, in order of Channel.
template <typename Visit>
constexpr void ForEachMessageType(Visit visit) {{
{visits}
}}

}}  // namespace terra::bus
"""


# ---- Samples ----

def number_for(message, field, at=0):
    """Never 0, another for each field, with its sign bit used where there is one."""
    value = zlib.crc32(f"{message.name}.{field.name}.{at}".encode())
    value = (value << 31 | value) % (1 << BITS[field.kind]) or 1
    return -value if field.kind == "int64_t" and value % 2 else value


def sample_value(message, field, at=0):
    if field.kind == "string":
        return f'"{field.name} {at}"' if field.counted_by else f'"{field.name}"'
    if field.kind == "double":
        return f"{zlib.crc32(f'{message.name}.{field.name}.{at}'.encode()) % 4096 / 8 + 0.125}"
    return str(number_for(message, field, at))


def samples(messages):
    text = HEAD + """#include "bus/message_schema.h"

namespace terra::testing {

/// One message of each type, every field filled with a value of its own.
template <typename T>
T FilledMessage();
"""
    for message in messages:
        sizes = {}
        lines = []
        for field in message.fields:
            if field.counts:
                sizes[field.name] = 2 + len(sizes)
                value = str(sizes[field.name])
            elif field.counted_by:
                value = "{" + ", ".join(sample_value(message, field, at)
                                        for at in range(sizes[field.counted_by])) + "}"
            else:
                value = sample_value(message, field)
            lines.append(f"  m.{field.name} = {value};")
        body = "\n".join(lines)
        text += f"""
template <>
inline terra_msg::{message.name} FilledMessage() {{
  terra_msg::{message.name} m{{}};
{body}
  return m;
}}
"""
    return text + "\n}  // namespace terra::testing\n"


# ---- The table ----

def table(messages):
    rows = ["| channel | type | rate | size, typical and largest | from | to | when it stops |",
            "|---|---|---|---|---|---|---|"]
    for message in messages:
        channel, _, where = message.tags["channel"].partition(" ")
        cells = [f"`{channel}`" + (f" {where}" if where else ""), f"`{message.name}`"]
        cells += [message.tags[tag] for tag in STRUCT_TAGS[1:]]
        rows.append("| " + " | ".join(cells) + " |")
    return "\n".join(rows) + "\n"


def put_table(path, text):
    document = path.read_text()
    if document.count(BEGIN) != 1 or document.count(END) != 1:
        sys.exit(f"{path}: the marks `{BEGIN}` and `{END}` must stand there once each")
    before, rest = document.split(BEGIN)
    path.write_text(before + BEGIN + "\n" + text + END + rest.split(END)[1])


WRITERS = {"channels": channels, "messages": messages_header, "samples": samples}


def main():
    what, *rest = sys.argv[1:] or ["--help"]
    if what == "table" and not rest:
        sys.stdout.write(table(all_messages()))
    elif what == "docs" and len(rest) == 1:
        put_table(pathlib.Path(rest[0]), table(all_messages()))
    elif what in WRITERS and len(rest) == 1:
        pathlib.Path(rest[0]).write_text(WRITERS[what](all_messages()))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
