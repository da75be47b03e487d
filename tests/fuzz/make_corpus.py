#!/usr/bin/env python3
"""Writes the seed inputs of the fuzz targets to corpus/ (they are committed)."""
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent
GOLDEN = HERE.parent / "bus" / "golden"
TYPES = ["map_header", "map_tile", "map_request", "plan_request", "baseline",
         "advice", "verdict", "deployed", "pose", "status", "config",
         "log_mark", "gate_step"]


def save(target, name, data):
    folder = HERE / "corpus" / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data)


def text(s):
    return struct.pack(">i", len(s) + 1) + s.encode() + b"\0"


def advice(route, kind=2, anchor=0, utime=1):
    """An encoded advice_t; an odd utime gets the right key from the target."""
    x, y = route[0] if route else (1, 1)
    body = struct.pack(">8q", utime, 2, 3, 1, 4, 5, 4711, 2)
    body += struct.pack(">3i", anchor, x, y)
    body += text("fuzz") + text("advisor") + text("chat") + text("model")
    body += struct.pack(">qiqbbb", 1, 1, 0, kind, 0, 0)
    body += struct.pack(">i", len(route))
    body += b"".join(struct.pack(">i", p[0]) for p in route)
    body += b"".join(struct.pack(">i", p[1]) for p in route)
    body += text("") + text("No.") + struct.pack(">qqdqq", 1, 2, 0.5, 3, 4)
    body += text("")
    return (GOLDEN / "advice_t.bin").read_bytes()[:8] + body


def datagram(payload, channel="TERRA_ADVICE"):
    return b"LC02" + struct.pack(">I", 7) + channel.encode() + b"\0" + payload


def chunk(kind, data):
    crc = zlib.crc32(kind + data)
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", crc)


def png(width, height, color, rows, depth=8, interlace=0, extra=b""):
    head = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, interlace)
    raw = b"".join(b"\0" + row for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + extra +
            chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


for number, name in enumerate(TYPES):
    save("messages", name, bytes([number]) +
         (GOLDEN / (name + "_t.bin")).read_bytes())

save("advice", "better", datagram(advice([(1, 1), (2, 0), (13, 0), (14, 9)])))
save("advice", "ahead", datagram(advice([(1, 5), (1, 8), (2, 9), (14, 9)],
                                        anchor=4)))
save("advice", "blocked", datagram(advice([(1, 1), (14, 9)])))
save("advice", "retain", datagram(advice([], kind=1)))
save("advice", "old_key", datagram(advice([(1, 1), (14, 9)], utime=2)))
save("advice", "other_channel", datagram(advice([]), "TERRA_POSE"))

save("map_files", "ids", b"\0" + png(3, 2, 0, [b"\0\1\2", b"\3\4\5"]))
save("map_files", "colours", b"\0" + png(1, 1, 2, [b"\0\0\0"]))
save("map_files", "interlaced",
     b"\0" + png(2, 2, 0, [b"\1", b"\2", b"\3\4"], interlace=1))
save("map_files", "palette",
     b"\0" + png(1, 1, 3, [b"\0"], extra=chunk(b"PLTE", b"\1\2\3")))
save("map_files", "sixteen_bits", b"\0" + png(1, 1, 0, [b"\0\0"], depth=16))
save("map_files", "transparent",
     b"\0" + png(1, 1, 0, [b"\0"], extra=chunk(b"tRNS", b"\0\0")))
save("map_files", "texts_and_profiles", b"\0" + png(
    1, 1, 0, [b"\0"],
    extra=chunk(b"gAMA", struct.pack(">I", 20000)) +
    chunk(b"iCCP", b"p\0\0" + zlib.compress(b"profile")) +
    chunk(b"zTXt", b"k\0\0" + zlib.compress(b"text"))))
save("map_files", "movingai",
     b"\1type octile\nheight 2\nwidth 3\nmap\n.@.\nTSW\n")
save("map_files", "pgm", b"\2P5\n# c\n3 2\n255\n\0\1\2\3\4\5")
save("map_files", "ros", b"\3image: map.pgm\nresolution: 0.05\n"
     b"origin: [0.0, -1.5, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
     b"free_thresh: 0.196\nmode: trinary\n")

save("tables", "csv", b'\0a,b\r\n1,"x ""y"", z"\n\n2,\n')
save("tables", "legend", b"\1id,name,cost,color\n0,wall,inf,#000000\n"
     b"1,grass,1.5,#00ff00\n")
save("tables", "cases", b"\2case_id,map,start_x,start_y,goal_x,goal_y,group\n"
     b"c1,maps/1.png,1,2,3,4,easy\nc2,maps/2.png,5,6,7,8,hard\n")

save("answers", "yes", b"\0**Yes.**")
save("answers", "no", b"\0No. [(1, 2), (30, 4), (5, 6)]")
save("answers", "lists", b"\0No.\n```\n[[1,2],[3,4]]\n```\nor [(1,2), (9,9)]")
save("answers", "route", b"\1[(0, 0), (10, 10)]")
save("answers", "route_text", b"\2[(1, 2), (-3, 4)]")
save("answers", "point", b"\x0312,-7")
save("answers", "record", b'\4{"schema":1,"request_hash":"ab","repeat":0,'
     b'"status":"answered","answer_text":"Yes"}')
save("answers", "openai", b'\5{"id":"r1","status":"completed","output":'
     b'[{"type":"message","content":[{"type":"output_text","text":"Yes"}]}],'
     b'"usage":{"input_tokens":5,"output_tokens":1}}')
save("answers", "gemini", b'\6{"candidates":[{"content":{"parts":[{"text":'
     b'"Yes"}]},"finishReason":"STOP"}],"usageMetadata":{"promptTokenCount":5}}')
save("answers", "anthropic", b'\7{"content":[{"type":"text","text":"Yes"}],'
     b'"stop_reason":"end_turn","usage":{"input_tokens":5,"output_tokens":1}}')
save("answers", "chat", b'\x08{"choices":[{"message":{"content":"Yes"},'
     b'"finish_reason":"stop"}],"usage":{"prompt_tokens":5}}')
save("answers", "error", b'\5{"error":{"message":"slow down","code":'
     b'"rate_limit_exceeded","type":"requests"}}')
save("answers", "openai_stream", b'\5event: response.completed\ndata: {"type":'
     b'"response.completed","response":{"status":"completed","output":[{"type":'
     b'"message","content":[{"type":"output_text","text":"Yes"}]}]}}\n\n')
save("answers", "gemini_stream", b'\6data: {"candidates":[{"content":{"parts":[{'
     b'"text":"Y"}]}}]}\r\n\r\ndata: {"candidates":[{"content":{"parts":[{"text":'
     b'"es"}]},"finishReason":"STOP"}]}\r\n\r\n')
save("answers", "anthropic_stream", b'\7event: message_start\ndata: {"type":'
     b'"message_start","message":{"usage":{"input_tokens":5}}}\n\ndata: {"type":'
     b'"content_block_delta","delta":{"type":"text_delta","text":"Yes"}}\n\n'
     b'data: {"type":"message_delta","delta":{"stop_reason":"end_turn"}}\n\n')
save("answers", "chat_stream", b'\x08: hm\n\ndata: {"choices":[{"delta":{'
     b'"content":"Yes"},"finish_reason":"stop"}]}\n\ndata: [DONE]\n\n')
save("answers", "deep", b'\x08{"choices":' + b"[" * 200 + b"]" * 200 + b"}")
save("answers", "batch", b'\x09{"custom_id":"ab-0","response":{"status_code":'
     b'200,"body":{"id":"r1","status":"completed","output":[]}},"error":null}')
save("answers", "batch_error", b'\x09{"custom_id":"ab-0","result":{"type":'
     b'"errored","error":{"type":"invalid_request"}}}')

save("model_answer", "chat", b'\x03{"choices":[{"message":{"content":"No. '
     b'[(1, 1), (1, 8), (14, 9)]"},"finish_reason":"stop"}],"model":"m"}')
save("model_answer", "chat_zero_byte", b'\x03{"choices":[{"message":{"content":'
     b'"Yes\\u0000"}}],"model":"a\\u0000\\u001b[2J"}')
save("model_answer", "chat_failure_inside", b'\x03{"choices":[{"error":{"code":'
     b'502,"message":"a\\u0000b"},"finish_reason":"error"}]}')
save("model_answer", "chat_thinking", b'\x03{"choices":[{"message":{"content":'
     b'"No. [(1, 1)].\\n</think>\\n\\nYes"}}]}')
save("model_answer", "chat_no_choice", b'\x03{"choices":[]}')
save("model_answer", "chat_status", b'\x0f{"error":{"message":"slow\\u0000"}}')
save("model_answer", "openai", b'\0{"id":"r1","status":"completed","output":'
     b'[{"type":"message","content":[{"type":"output_text","text":"Yes"}]}]}')
save("model_answer", "openai_key", b'\0{"status":"completed","output":[{"type":'
     b'"message","content":[{"type":"refusal","refusal":"sk-fuzz-0123456789"}]}]}')
save("model_answer", "gemini_route", b'\x21{"candidates":[{"content":{"parts":[{'
     b'"text":"[(1, 1), (14, 9)]"}]},"finishReason":"STOP"}]}')
save("model_answer", "gemini_targets", b'\x31{"candidates":[{"content":{"parts":'
     b'[{"text":"[(1, 8)]"}]},"finishReason":"STOP"}]}')
save("model_answer", "anthropic", b'\x02{"content":[{"type":"text","text":'
     b'"Yes\\u00a0"}],"stop_reason":"end_turn"}')
save("model_answer", "anthropic_stream", b'\x02data: {"type":"error","error":{'
     b'"type":"overloaded_error","message":"Overloaded"}}\n\n')

save("exchange", "yes", b"Yes\n")
save("exchange", "route", b"No. [(1, 1), (1, 8), (14, 9)]\n")
save("exchange", "zero_byte", b"No. [(1, 1), (1\0, 8), (14, 9)]")
save("exchange", "utf16", "No. [(1, 1), (14, 9)]".encode("utf-16"))
save("exchange", "latin1", "Yes, \u00e7a va".encode("latin-1"))
save("exchange", "cut_character", "Yes \u20ac".encode()[:-1])
save("exchange", "terminal", b"\x1b[2J\x1b]0;title\x07 No.\xc2\x9b")
save("exchange", "blank", b"\xef\xbb\xbf\n")
save("exchange", "thinking", b"No. [(1, 1)]\n</think>\n\nYes")

save("config", "advisor", b'\0backend="chat"\nrobot="R1"\npolish=false\n'
     b'lcm-url="udpm://239.255.76.67:7667?ttl=0"\n')
save("config", "unknown_key", b"\0no-such-option=1\n")
save("config", "section", b"\0# c\n[a.b]\nc=[1, 2, 'x']\n")
save("config", "url", b"\1udpm://239.255.76.67:7667?ttl=1&recv_buf_size=99")
save("config", "url_last_port", b"\1udpm://:65535")


def event(number, channel, data):
    return struct.pack(">Iqqii", 0xEDA1DA01, number, 1000 * number,
                       len(channel), len(data)) + channel.encode() + data


LOG = b"".join(
    event(number, "TERRA_" + name.upper().removesuffix("_MARK"),
          (GOLDEN / (name + "_t.bin")).read_bytes())
    for number, name in enumerate(TYPES))
save("logs", "one_of_each", LOG)
save("logs", "torn", LOG[:-40])
save("logs", "damaged", LOG[:300] + b"\0\1\2" + LOG[310:])
