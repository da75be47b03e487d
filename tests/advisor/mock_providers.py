"""A second implementation of the providers' forms, written from their documents
alone: a strict server on 127.0.0.1 that refuses what they would refuse.

usage: mock_providers.py [--port N] [--answer TEXT]     serves until Ctrl-C
"""

import argparse
import base64
import http.server
import json
import re
import struct
import threading

LONGEST_SIDE = 1568  # beyond it providers shrink pictures themselves
SIGNATURE = b"\x89PNG\r\n\x1a\n"


class Refused(Exception):
    """What the server says against a request."""


def need(holds, complaint):
    if not holds:
        raise Refused(complaint)


def exact(value, keys, where):
    need(isinstance(value, dict) and set(value) == set(keys),
         f"{where}: wants {sorted(keys)}")
    return value


def check_png(text, where):
    data = base64.b64decode(text, validate=True)
    need(data[:8] == SIGNATURE and data[12:16] == b"IHDR", f"{where}: no PNG")
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    need((depth, kind) == (8, 2), f"{where}: 8-bit RGB, please")
    need(max(width, height) <= LONGEST_SIDE, f"{where}: {width} x {height}")


def check_uri(uri, where):
    head, _, data = uri.partition(",")
    need(head == "data:image/png;base64", f"{where}: {head}")
    check_png(data, where)


def check_parts(parts, picture, text):
    """Pictures first, then one text; each form reads its own parts."""
    need(len(parts) >= 2, "a picture and a text, please")
    for part in parts[:-1]:
        picture(part)
    words = text(parts[-1])
    need("Start: (" in words and words.isascii(), "no question in the text")


def only(items):
    need(isinstance(items, list) and len(items) == 1, "one item, please")
    return items[0]


class OpenAi:
    path = re.compile(r"/v1/responses")

    def check(self, headers, body, key):
        need(headers["authorization"] == f"Bearer {key}", "authorization")
        exact(body, {"model", "input", "max_output_tokens", "reasoning"}, "body")
        exact(body["reasoning"], {"effort"}, "reasoning")
        message = exact(only(body["input"]), {"role", "content"}, "input")

        def picture(part):
            exact(part, {"type", "image_url", "detail"}, "input_image")
            need(part["detail"] in ("low", "high", "auto", "original"), "detail")
            need(part["type"] == "input_image", "type")
            check_uri(part["image_url"], "image_url")

        def text(part):
            need(part["type"] == "input_text", "type")
            return exact(part, {"type", "text"}, "input_text")["text"]
        check_parts(message["content"], picture, text)
        return body["model"]

    def busy(self):
        return 429, {"retry-after-ms": "20"}, {"error": {
            "message": "slow down", "type": "requests", "param": None,
            "code": "rate_limit_exceeded"}}

    def reply(self, model, answer):
        def said(text, phase):
            return {"type": "message", "id": "msg_1", "role": "assistant",
                    "status": "completed", "phase": phase,
                    "content": [{"type": "output_text", "text": text,
                                 "annotations": []}]}
        return {"id": "resp_1", "object": "response", "status": "completed",
                "error": None, "incomplete_details": None,
                "model": model + "-2026-01-01",
                "output": [{"type": "reasoning", "id": "rs_1", "summary": []},
                           said("Let me look at the map.", "commentary"),
                           said(answer, "final_answer")],
                "usage": {"input_tokens": 4000, "output_tokens": 900,
                          "input_tokens_details": {"cached_tokens": 0},
                          "output_tokens_details": {"reasoning_tokens": 850},
                          "total_tokens": 4900}}


class Anthropic:
    path = re.compile(r"/v1/messages")

    def check(self, headers, body, key):
        need(headers["x-api-key"] == key, "x-api-key")
        need("authorization" not in headers, "two kinds of authentication")
        need(headers["anthropic-version"] in ("2023-06-01", "2026-10-21"),
             "anthropic-version")
        exact(body, {"model", "max_tokens", "thinking", "output_config",
                     "messages"}, "body")
        need(body["thinking"] == {"type": "adaptive"}, "thinking")
        exact(body["output_config"], {"effort"}, "output_config")
        message = exact(only(body["messages"]), {"role", "content"}, "messages")

        def picture(part):
            source = exact(part, {"type", "source"}, "image")["source"]
            exact(source, {"type", "media_type", "data"}, "source")
            need((part["type"], source["type"], source["media_type"]) ==
                 ("image", "base64", "image/png"), "image")
            check_png(source["data"], "source.data")

        def text(part):
            need(part["type"] == "text", "type")
            return exact(part, {"type", "text"}, "text")["text"]
        check_parts(message["content"], picture, text)
        return body["model"]

    def busy(self):
        return 529, {}, {"type": "error", "request_id": "req_1", "error": {
            "type": "overloaded_error", "message": "Overloaded"}}

    def reply(self, model, answer):
        half = len(answer) // 2
        return {"id": "msg_1", "type": "message", "role": "assistant",
                "model": model, "stop_reason": "end_turn",
                "stop_sequence": None, "stop_details": None,
                "content": [{"type": "thinking", "thinking": "", "signature": "x"},
                            {"type": "redacted_thinking", "data": "eA=="},
                            {"type": "text", "text": answer[:half]},
                            {"type": "text", "text": answer[half:]}],
                "usage": {"input_tokens": 1000, "output_tokens": 900,
                          "cache_creation_input_tokens": None,
                          "cache_read_input_tokens": 3000}}


class Gemini:
    path = re.compile(r"/v1beta/models/([\w.-]+):generateContent")

    def check(self, headers, body, key):
        need(headers["x-goog-api-key"] == key, "x-goog-api-key")
        exact(body, {"contents", "generationConfig"}, "body")
        config = exact(body["generationConfig"],
                       {"maxOutputTokens", "thinkingConfig"}, "generationConfig")
        need(config["thinkingConfig"].get("thinkingLevel") in
             ("MINIMAL", "LOW", "MEDIUM", "HIGH"), "thinkingLevel")
        content = exact(only(body["contents"]), {"role", "parts"}, "contents")

        def picture(part):
            data = exact(exact(part, {"inlineData"}, "part")["inlineData"],
                         {"mimeType", "data"}, "inlineData")
            need(data["mimeType"] == "image/png", "mimeType")
            check_png(data["data"], "inlineData")

        def text(part):
            return exact(part, {"text"}, "part")["text"]
        check_parts(content["parts"], picture, text)
        return None

    def busy(self):
        return 503, {}, {"error": {
            "code": 503, "status": "UNAVAILABLE", "message": "overloaded",
            "details": [{"@type": "type.googleapis.com/google.rpc.RetryInfo",
                         "retryDelay": "0.02s"}]}}

    def reply(self, model, answer):
        return {"candidates": [{"index": 0, "finishReason": "STOP", "content": {
            "role": "model",
            "parts": [{"text": "The baseline detours.", "thought": True},
                      {"text": answer, "thoughtSignature": "eA=="}]}}],
                "modelVersion": model, "responseId": "r1",
                "usageMetadata": {"promptTokenCount": 4000,
                                  "candidatesTokenCount": 50,
                                  "thoughtsTokenCount": 850,
                                  "totalTokenCount": 4900}}


class Chat:
    path = re.compile(r"/v1/chat/completions")

    def check(self, headers, body, key):
        need(headers.get("authorization") in (None, f"Bearer {key}"),
             "authorization")
        exact(body, {"model", "max_tokens", "messages"}, "body")
        message = exact(only(body["messages"]), {"role", "content"}, "messages")

        def picture(part):
            exact(part, {"type", "image_url"}, "part")
            need(part["type"] == "image_url", "type")
            check_uri(exact(part["image_url"], {"url"}, "image_url")["url"], "url")

        def text(part):
            need(part["type"] == "text", "type")
            return exact(part, {"type", "text"}, "text")["text"]
        check_parts(message["content"], picture, text)
        return body["model"]

    def busy(self):
        return 503, {"Retry-After": "1"}, {"error": {
            "code": 503, "message": "Loading model", "type": "unavailable_error"}}

    def reply(self, model, answer):
        return {"id": "chatcmpl-1", "object": "chat.completion", "model": model,
                "choices": [{"index": 0, "finish_reason": "stop", "message": {
                    "role": "assistant",
                    "content": "<think>Yes or No?</think>\n" + answer}}],
                "usage": {"prompt_tokens": 4000, "completion_tokens": 900,
                          "total_tokens": 4900}}


PROVIDERS = {"openai": OpenAi(), "anthropic": Anthropic(), "gemini": Gemini(),
             "chat": Chat()}


class Server:
    """Refuses the first good request of each provider as busy, answers the
    others. `seen` and `complaints` tell what came."""

    def __init__(self, answer, key="none", port=0):
        self.answer, self.key = answer, key
        self.seen, self.complaints = [], []
        outer = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_POST(self):
                length = int(self.headers["content-length"])
                status, headers, body = outer.handle(
                    self.path, {k.lower(): v for k, v in self.headers.items()},
                    self.rfile.read(length))
                data = json.dumps(body).encode()
                self.send_response(status)
                for name, value in headers.items():
                    self.send_header(name, value)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(data)))
                self.end_headers()
                self.wfile.write(data)

            def log_message(self, *_):
                pass

        self.http = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.url = f"http://127.0.0.1:{self.http.server_port}"
        threading.Thread(target=self.http.serve_forever, daemon=True).start()

    def handle(self, path, headers, data):
        for name, provider in PROVIDERS.items():
            found = provider.path.fullmatch(path)
            if found:
                break
        else:
            self.complaints.append(path)
            return 404, {}, {"error": {"message": f"no {path} here"}}
        try:
            need(headers.get("content-type") == "application/json", "content-type")
            need("expect" not in headers, "expect")
            model = provider.check(headers, json.loads(data), self.key)
            model = model or found.group(1)
        except (Refused, KeyError, TypeError, ValueError) as error:
            self.complaints.append(f"{name}: {error!r}")
            return 400, {}, {"error": {"message": str(error)}}
        self.seen.append(name)
        if self.seen.count(name) == 1:
            return provider.busy()
        return 200, {}, provider.reply(model, self.answer)

    def close(self):
        self.http.shutdown()
        self.http.server_close()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--port", type=int, default=4010)
    parser.add_argument("--answer", default="Yes")
    options = parser.parse_args()
    server = Server(options.answer, port=options.port)
    print(server.url, flush=True)
    try:
        threading.Event().wait()
    except KeyboardInterrupt:
        print("asked:", server.seen, "complaints:", server.complaints)


if __name__ == "__main__":
    main()
