"""Pictures of recordings, by the stock Rerun viewer without a display.

    python screenshots/viewer.py FILE.rrd OUT.png [TIMELINE=TIME] [WIDTHxHEIGHT]

Needs rerun-sdk 0.36.3 and a Vulkan driver; a software one will do (Debian: mesa-vulkan-drivers). The viewer is told to
show a time by its own tool server, after everything in the file has arrived.
"""

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import rerun
from rerun.experimental import RrdReader

PROGRAM = Path(rerun.__file__).parent.parent / "rerun_cli" / "rerun"


class Viewer:
    """A viewer without a window, and the tool server that drives it."""

    def __init__(self, recording, size):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.runtime = tempfile.TemporaryDirectory()
        env = dict(os.environ, RUST_LOG="error", NO_COLOR="1", XDG_RUNTIME_DIR=self.runtime.name)
        env.pop("DISPLAY", None)
        viewer = [PROGRAM, recording, "--headless", "--hide-welcome-screen", "--window-size", size]
        viewer += ["--bind", "127.0.0.1", "--port", str(port)]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": env, "start_new_session": True}
        self.viewer = subprocess.Popen(viewer, **quiet)
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self.tools = subprocess.Popen([PROGRAM, "viewer-mcp"], **{**quiet, **pipes})
        self.count = 0
        self._ask(
            "initialize",
            {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "pictures", "version": "1"}},
        )
        self._say({"jsonrpc": "2.0", "method": "notifications/initialized"})
        deadline = time.time() + 60
        while True:
            try:
                self.call("connect", endpoint=f"http://127.0.0.1:{port}")
                return
            except RuntimeError:
                if time.time() > deadline:
                    raise
                time.sleep(0.2)

    def _say(self, message):
        self.tools.stdin.write(json.dumps(message) + "\n")
        self.tools.stdin.flush()

    def _ask(self, method, params):
        self.count += 1
        self._say({"jsonrpc": "2.0", "id": self.count, "method": method, "params": params})
        for line in self.tools.stdout:
            answer = json.loads(line)
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise RuntimeError(answer["error"])
                return answer["result"]
        raise RuntimeError("the viewer's tool server ended")

    def call(self, tool, **arguments):
        result = self._ask("tools/call", {"name": tool, "arguments": arguments})
        if result.get("isError"):
            raise RuntimeError(result["content"])
        return "".join(part.get("text", "") for part in result["content"])

    def close(self):
        for process in (self.tools, self.viewer):
            try:
                os.killpg(process.pid, signal.SIGTERM)
            except ProcessLookupError:
                pass
            process.wait(20)
        self.runtime.cleanup()


def ranges(recording):
    """First and last time of every timeline in the file."""
    found = {}
    for chunk in RrdReader(recording).stream():
        batch = chunk.to_record_batch()
        for index, field in enumerate(batch.schema):
            if (field.metadata or {}).get(b"rerun:kind") == b"index" and batch.num_rows:
                times = batch.column(index).cast("int64").to_pylist()
                first, last = found.get(field.name, (min(times), max(times)))
                found[field.name] = (min(first, *times), max(last, *times))
    return found


def main():
    recording, picture, *rest = sys.argv[1:]
    size = next((word for word in rest if "=" not in word), "1920x1080")
    times = [word.split("=") for word in rest if "=" in word]
    wanted = ranges(recording)
    viewer = Viewer(recording, size)
    try:
        deadline = time.time() + 120
        while True:
            state = json.loads(viewer.call("viewer_state"))
            shown = {
                line["timeline"]: (line["min"], line["max"])
                for part in state.get("recordings", [])
                for line in part.get("timelines", [])
            }
            if all(shown.get(name) == span for name, span in wanted.items()):
                break
            if time.time() > deadline:
                raise SystemExit(f"the viewer did not load all of {recording}: {shown} of {wanted}")
            time.sleep(0.1)
        viewer.call("wait_for", min_steps=20, timeout_secs=60)
        for timeline, moment in times:
            viewer.call("set_time", timeline=timeline, time=int(moment))
            viewer.call("wait_for", min_steps=20, timeout_secs=60)
        viewer.call("screenshot", save_path=os.path.abspath(picture), pixels_per_point=1.0)
        print(f"wrote {picture}")
    finally:
        viewer.close()


if __name__ == "__main__":
    main()
