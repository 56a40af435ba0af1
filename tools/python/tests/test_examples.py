"""The examples run. Each is a program of its own."""

import functools
import http.server
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[2]
EXAMPLES = TOOLS / "python/examples"


def run(name, *arguments, cwd):
    command = [sys.executable, EXAMPLES / name, *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_bones_and_texture_follow_a_cut(tmp_path):
    assert "pieces: 2" in run("bones.py", cwd=tmp_path)


def test_toughness_is_swept_and_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    assert "4 J/m: " in run("toughness.py", "toughness.png", "--quick", cwd=tmp_path)
    assert (tmp_path / "toughness.png").stat().st_size > 10_000


def test_blender_cuts_an_object_and_plays_a_cache(tmp_path):
    pytest.importorskip("bpy")
    assert "2 pieces" in run("blender.py", tmp_path, cwd=tmp_path)
    assert (tmp_path / "cloth.blend").exists()


def test_a_page_of_three_js_shows_the_module(tmp_path):
    tools = [shutil.which(tool) for tool in ["chromium", "npm", "gzip"]]
    if not all(tools):
        pytest.skip("needs chromium, npm and gzip")
    chromium, npm, gzip = tools
    subprocess.run([npm, "install", "--silent", "three@0.180"], cwd=tmp_path, check=True)
    shutil.copy(TOOLS / "view/play/three.html", tmp_path)
    with open(tmp_path / "module.wasm", "wb") as module:
        packed = TOOLS / "view/src/play/module.wasm.gz"
        subprocess.run([gzip, "-dc", packed], stdout=module, check=True)
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=tmp_path)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = f"http://127.0.0.1:{server.server_port}/three.html"
        flags = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"]
        flags += ["--enable-unsafe-swiftshader", "--virtual-time-budget=3000", "--dump-dom"]
        shown = subprocess.run([chromium, *flags, page], capture_output=True, text=True, timeout=300)
        server.shutdown()
    assert "1089 vertices, 2048 faces, 1 pieces</title>" in shown.stdout, shown.stderr[-2000:]
