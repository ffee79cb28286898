# SPDX-License-Identifier: BSD-3-Clause
"""`se3d live` as a page, and as others, would ask it: python3 live.py PROGRAM FOLDER RANDOM_REQUESTS

FOLDER is empty and may be written to. Prints what fails, and how long a saved file takes.
"""
import base64
import http.client
import json
import math
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import time

program, folder, requests = sys.argv[1], sys.argv[2], int(sys.argv[3])
checks = failures = 0


def check(holds, text):
    global checks, failures
    checks += 1
    if not holds:
        failures += 1
        print(f"failed: {text}", file=sys.stderr)


MODEL = """se3d: 1
title: {title}
parameters: {{weight: 2 kg, k: 50 N/m}}
bodies:
  - {{name: block, mass: weight, inertia: [1, 1, 1], position: [{x}, 0, 0]}}
joints:
  - {{name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}}
forces:
  - {{name: push, type: effort, joint: rail, value: 0}}
include:
  - {{file: spring.part, parameters: {{k: k}}}}
analysis: {{type: dynamics, duration: 10}}
output:
  - {{file: a.csv, channels: [block.position, rail.rate, energy.total]}}
"""
SPRING = """se3d: 1
parameters: {{k: 1}}
forces:
  - {{name: spring, type: tsda, body_i: ground, body_j: block, point_i: [-1, 0, 0], point_j: [0, 0, 0], k: {k}, l0: 1}}
"""


def save(name, text):
    """As editors do: another file gets the name."""
    path = os.path.join(folder, name)
    with open(path + "~", "w") as file:
        file.write(text)
    os.rename(path + "~", path)


class Live:
    def __init__(self, *words):
        self.process = subprocess.Popen([program, "live", *words], stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        check(self.address.startswith("http://127.0.0.1:"), f"the address is {self.address}")
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.path = "/" + self.address.split("/", 3)[3]
        self.connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=5)
        self.state = None

    def ask(self, method, path, body=None, **headers):
        self.connection.request(method, path, body, {k.replace("_", "-"): v for k, v in headers.items()})
        answer = self.connection.getresponse()
        return answer.status, answer.read().decode(), answer.headers

    def raw(self, data):
        """The status of what comes back for these bytes, 0: nothing."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=0.2) as s: # who asks for the next state waits
            answer = b""
            try: # it may close before it has read all
                s.sendall(data)
                s.shutdown(socket.SHUT_WR)
            except OSError:
                pass
            try:
                while len(answer) < 12 and (more := s.recv(4096)):
                    answer += more
            except OSError:
                pass
        return int(answer[9:12]) if answer[:5] == b"HTTP/" else 0

    def say(self, words):
        status, text, _ = self.ask("POST", self.path + "do", words)
        check(status == 200, f"{words}: {status} {text}")

    def next(self, wanted=lambda state: True):
        """The next state of which this holds."""
        end = time.monotonic() + 20
        while time.monotonic() < end:
            after = self.state["sequence"] if self.state else 0
            try:
                status, text, _ = self.ask("GET", f"{self.path}state?after={after}")
            except OSError: # nothing happens any more
                self.connection.close()
                break
            if status != 200:
                break
            self.state = json.loads(text)
            if wanted(self.state):
                return self.state
        check(False, f"the state never came; the last one is {str(self.state)[:300]}")
        return self.state

    def scene(self):
        return json.loads(self.ask("GET", self.path + "scene")[1])

    def slider(self, name):
        return [s["name"] for s in self.scene()["sliders"]].index(name)

    def set(self, name, value):
        self.say(f"set {self.state['list']} {self.slider(name)} {value}")
        return self.next()

    def cpu(self):
        """Ticks; 0 if the system does not tell them."""
        if not os.path.exists("/proc/self/stat"):
            return 0
        with open(f"/proc/{self.process.pid}/stat") as file:
            words = file.read().rsplit(")", 1)[1].split()
        return int(words[11]) + int(words[12])


class Other(Live):
    """Another model for a while, paused at its start."""
    def __init__(self, name, *words):
        super().__init__(os.path.join(folder, name), "-q", *words)
        for word in ("pause", "reset", "speed 0.5"):
            self.say(word)
        self.next(lambda s: s["speed"] == 0.5)
        self.say("speed 1")
        self.next(lambda s: s["speed"] == 1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        check(self.process.wait(10) == 0, "SIGTERM ends it")


def check_guards(live):
    path, own = live.path, f"127.0.0.1:{live.port}"
    status, page, headers = live.ask("GET", path)
    check(status == 200 and "se3dView" in page, "the page")
    check("default-src 'none'" in headers["Content-Security-Policy"], "what the page may load")
    check(headers["Cache-Control"] == "no-store" and headers["Referrer-Policy"] == "no-referrer", "headers")
    wrong = "/" + ("0" if path[1] != "0" else "1") + path[2:]
    for what, status, method, place, head in [
            ("no token", 403, "GET", "/", {}), ("another token", 403, "GET", wrong, {}),
            ("a part of it", 403, "GET", path[:-2] + "/", {}), ("no slash", 403, "GET", path[:-1], {}),
            ("a name that points here", 403, "GET", path, {"Host": "evil.example"}),
            ("another port", 403, "GET", path, {"Host": "127.0.0.1:1"}),
            ("localhost", 200, "GET", path, {"Host": f"localhost:{live.port}"}),
            ("another origin", 403, "GET", path + "scene", {"Origin": "http://evil.example"}),
            ("no origin", 403, "POST", path + "do", {"Origin": "null"}),
            ("a secure one", 403, "POST", path + "do", {"Origin": "https://" + own}),
            ("its own", 200, "GET", path + "scene", {"Origin": "http://" + own}),
            ("another site", 403, "GET", path, {"Sec-Fetch-Site": "cross-site"}),
            ("DELETE", 405, "DELETE", path, {}), ("PUT", 405, "PUT", path + "do", {}),
            ("a word to the page", 404, "POST", path, {}), ("no such thing", 404, "GET", path + "other", {}),
            ("a file", 404, "GET", path + "../../etc/passwd", {}), ("an argument", 200, "GET", path + "state?after=x", {}),
            ("a later state", 200, "GET", path + "state?after=123456789", {}),
            ("words without end", 413, "POST", path + "do", {"body": "set " + "1" * 300}),
            ("a zero", 400, "POST", path + "do", {"body": "run\0"})]:
        answer, text, _ = live.ask(method, place, head.pop("body", None), **head)
        check(answer == status, f"{what}: {answer} in place of {status}: {text[:80]}")
    for _ in range(80): # clients who go at once do not fill the places of others
        check(live.raw(f"POST {path}do HTTP/1.1\r\nHost: {own}\r\nContent-Length: 5\r\n\r\npause".encode()) == 200, "it answers at once")
    live.say("run")
    lines = f"GET {path} HTTP/1.1\r\n"
    check(live.raw(f"GET {path} HTTP/1.0\r\n\r\n".encode()) == 403, "no host")
    check(live.raw(f"{lines}Host: {own}\r\nHost: {own}\r\n\r\n".encode()) in (400, 403), "two hosts")
    check(live.raw(f"{lines}Host: {own}\r\nX: {'y' * 100000}\r\n\r\n".encode()) in (0, 413, 431), "a long header")
    check(live.raw(f"GET {path}{'y' * 100000} HTTP/1.1\r\n\r\n".encode()) in (0, 400, 403, 414), "a long path")
    with socket.socket() as s: # other addresses of this machine do not answer
        s.settimeout(5)
        check(s.connect_ex(("127.0.0.2", live.port)) != 0, "127.0.0.1 only")


def check_motion(live):
    scene = live.scene()
    glb = base64.b64decode(scene["glb"])
    names = scene["results"]["names"]
    check(glb[:4] == b"glTF" and len(glb) > 1000, "the scene is glTF")
    check(names[:2] == ["time", "block.position.x"] and scene["results"]["units"][1] == "m", f"{names}")
    check([s["name"] for s in scene["sliders"]] == ["push.input", "weight", "k"], "sliders")
    state = live.next(lambda s: s["t"] > 0.05)
    check(state["running"] and state["version"] == scene["version"], "it runs at once")
    live.say("pause")
    state = live.next(lambda s: not s["running"])
    # 0.3 cos(5 t); body 1 comes after the ground, and then what is drawn between two bodies.
    x = state["places"][7]
    check(abs(x - 0.3 * math.cos(5 * state["t"])) < 1e-5, f"x = {x} at t = {state['t']}")
    check(len(state["places"]) == 2 * 7 + 10 and state["values"][0] == x, "places and values")
    live.say("step")
    after = live.next(lambda s: s["t"] > state["t"])
    check(abs(after["t"] - state["t"] - 1 / 60) < 1e-9 and not after["running"], "a step is a 60th of a second")
    live.say("reset")
    check(abs(live.next(lambda s: s["t"] == 0)["places"][7] - 0.3) < 1e-9, "reset goes to the start")
    for words in ["", "step 1", "set", f"set {state['list']} 1 nan", f"set {state['list']} 99 1", f"set {state['list'] + 1} 1 3", "jump",
                  "pull 1 0 0 0 0 1 1 1", f"pull {state['version']} 0 0 0 0 1 1 1", "speed -1", "set 1e999 1 1", "run\n"]:
        live.say(words)
    live.say("pause")
    state = live.next()
    check(state["t"] == 0 and state["numbers"] == [0, 2, 50] and not state["running"], "wrong words change nothing")


def check_numbers(live):
    live.set("push.input", 15)  # the spring's force at the start
    live.say("step")
    state = live.next(lambda s: s["t"] > 0)
    check(abs(state["places"][7] - 0.3) < 1e-6, f"the effort holds the block at {state['places'][7]}")
    state = live.set("push.input", 0)
    for _ in range(6):
        live.say("step")
        state = live.next()
    before = state["places"][7], state["t"]
    state = live.set("weight", 8)
    check(abs(state["places"][7] - before[0]) < 1e-6 and state["t"] == before[1], "the motion goes on with another mass")
    t0, x0, v0 = state["t"], state["values"][0], state["values"][3]
    live.say("step")
    state = live.next(lambda s: s["t"] > t0)
    s, w = 1 / 60, math.sqrt(50 / 8)
    check(abs(state["values"][0] - x0 * math.cos(w * s) - v0 / w * math.sin(w * s)) < 1e-6, "as such a mass moves")
    check(state["numbers"] == [0, 8, 50], f"{state['numbers']}")
    state = live.set("k", -1e300)
    check("k = -1e+300" in state["trouble"], f"an absurd number is told: {state['trouble']}")
    live.say("anew")
    state = live.next(lambda s: s["t"] == 0)
    check(state["numbers"] == [0, 2, 50], "the numbers of the file")
    live.say(f"pull {state['version']} 1 0 0 0 3 0 0")
    for _ in range(40):
        live.say("step")
        state = live.next()
    check(state["places"][7] > 0.35, f"the block is pulled to {state['places'][7]}")
    live.say("release")
    live.say("speed 0")
    live.say("run")
    begin = time.monotonic()
    state = live.next(lambda s: s["t"] > 5)
    check(time.monotonic() - begin < 5, "faster than time")
    energy = state["values"][4]
    check(abs(live.next(lambda s: s["t"] > 6)["values"][4] - energy) < 1e-3 * energy, "nothing pulls any more")
    live.say("speed 1")


def check_saving(live):
    slowest = 0
    version = live.state["version"]
    for name, text in [("model.yaml", MODEL.format(title="two", x=0.7)), ("spring.part", SPRING.format(k=70)),
                       ("model.yaml", MODEL.format(title="three", x=0.1))]:
        begin = time.monotonic()
        save(name, text)
        state = live.next(lambda s: s["version"] > version or (name == "spring.part" and s["t"] < 0.1))
        live.scene()
        slowest = max(slowest, time.monotonic() - begin)
        version = state["version"]
    print(f"{1000 * slowest:.0f} ms from saving to the new scene")
    check(state["trouble"] == "" and abs(state["places"][7]) <= 0.11, "the new model")
    save("model.yaml", MODEL.format(title="four", x=0.1).replace("type: prismatic", "type: prismatik"))
    state = live.next(lambda s: s["trouble"])
    check("model.yaml:7:" in state["trouble"] and "prismatik" in state["trouble"], state["trouble"])
    check(state["version"] == version and len(state["places"]) == 24, "the old picture stays")
    save("model.yaml", MODEL.format(title="<b>&\\\"", x=0.1))
    state = live.next(lambda s: s["version"] > version)
    check(state["trouble"] == "", "and the new one comes")
    os.remove(os.path.join(folder, "spring.part"))
    save("model.yaml", MODEL.format(title="five", x=0.1))
    check("spring.part" in live.next(lambda s: s["trouble"])["trouble"], "a file that is gone")
    save("spring.part", SPRING.format(k=50))
    live.next(lambda s: not s["trouble"])


SCREW = """se3d: 1
parameters: {weight: 2 kg, other: 3}
bodies:
  - {name: nut, mass: weight, inertia: [1, 1, 1], position: [0, 0, 0]}
joints:
  - {name: thread, type: screw, body_i: ground, body_j: nut, at: [0, 0, 0], axis: [1, 0, 0], pitch: 0.1}
forces:
  - {name: spin, type: effort, joint: thread, coordinate: angle, value: 30}
analysis: {type: dynamics, duration: 10}
output:
  - {file: a.csv, channels: [nut.position.x, thread.angle]}
"""


def check_turns():
    """Joints keep the turns that they have counted."""
    save("screw.yaml", SCREW)
    with Other("screw.yaml") as live:
        for _ in range(60):
            live.say("step")
            state = live.next()
        x, angle = state["values"]
        check(angle > 4 * math.pi, f"it has turned by {angle}")
        state = live.set("weight", 3)
        check(max(abs(state["values"][0] - x), abs(state["values"][1] - angle)) < 1e-9 and state["trouble"] == "",
              f"the nut goes on: {state['values']} after {x}, {angle}; {state['trouble']}")
        live.say("step")
        state = live.next()
        check(0 < state["values"][1] - angle < 1 and abs(state["values"][0] / state["values"][1] - x / angle) < 1e-7, f"along the thread: {state['values']}")


RATE = """se3d: 1
parameters: {weight: 2 kg}
bodies:
  - {name: wheel, mass: weight, inertia: [1, 1, 1], position: [0, 0, 0]}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: wheel, at: [0, 0, 0], axis: [0, 0, 1]}
drivers:
  - {name: turn, joint: pin, rate: 3}
analysis: {type: dynamics, duration: 10}
output:
  - {file: a.csv, channels: [pin.angle, pin.rate]}
"""


def check_rates():
    """A rate that was set on the way has brought its joint to where it stays."""
    save("rate.yaml", RATE)
    with Other("rate.yaml") as live:
        for _ in range(30):
            live.say("step")
        live.next(lambda s: abs(s["t"] - 0.5) < 1e-9)
        live.set("turn.input", 5)
        for _ in range(30):
            live.say("step")
        live.next(lambda s: abs(s["t"] - 1) < 1e-9)
        state = live.set("weight", 4)
        check(max(abs(a - b) for a, b in zip(state["values"], [4, 5])) < 1e-6 and state["trouble"] == "", f"{state['values']}")


POST = """\
se3d: 1
parameters: {stiffness: 1e4 N/m}
bodies: [{name: wheel, mass: 10, inertia: [1, 1, 1], position: [0, 0, 0.3]}]
joints: [{name: held, type: fixed, body_i: ground, body_j: wheel, at: [0, 0, 0.3]}]
roads: [{name: wave, type: height, height: 0.01*sin(x + t)}, {name: post, type: height, height: 0.02*sin(3*t)}]
forces:
  - {name: t1, type: tyre, body: wheel, road: post, radius: 0.31, k: stiffness, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4}
  - {name: t2, type: tyre, body: wheel, road: wave, radius: 0.31, k: 1e4, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4}
analysis: {type: dynamics, duration: 10}
"""


def check_roads():
    """A road that rises as a whole does so in the picture; one that changes its form stands still."""
    save("post.yaml", POST)
    with Other("post.yaml") as live:
        for _ in range(30):
            live.say("step")
        state = live.next(lambda s: abs(s["t"] - 0.5) < 1e-9)
        wave, post = state["places"][-2:]
        check(wave == 0 and abs(post - 0.02 * math.sin(1.5)) < 1e-7, f"roads have risen by {wave}, {post}")
        version = state["version"]
        state = live.set("stiffness", 2e4)
        check(state["version"] == version and abs(state["places"][-1] - 0.02 * math.sin(3 * state["t"])) < 1e-7, "another number leaves the picture")


GRAINS = """\
se3d: 1
parameters: {push: 1 m/s}
materials: [{name: glass, density: 2500, friction: 0.4, restitution: 0.6, stiffness: 2e4}]
contact: {law: hooke}
particles: [{material: glass, radius: 0.01, packing: lattice, seed: 1, lower: [0, 0, 1], upper: [0.1, 0.1, 1.1]}]
bodies: [{name: blade, mass: 1, inertia: [1, 1, 1], position: [2, 0, 0]}]
joints: [{name: rail, type: prismatic, body_i: ground, body_j: blade, at: [2, 0, 0], axis: [1, 0, 0]}]
drivers: [{name: way, joint: rail, value: "push*t"}]
analysis: {type: KIND, duration: 1}
"""


def check_grains():
    """Particles fall beside bodies, with and without dynamics, and go on where they are."""
    for kind in ("kinematics", "dynamics"):
        save("grains.yaml", GRAINS.replace("KIND", kind))
        with Other("grains.yaml") as live:
            box = live.scene()["box"]
            check(0.99 < box[2] < box[5] < 1.11, f"the box of the particles: {box}")
            places = lambda: struct.unpack("<%df" % (len(base64.b64decode(live.state["grains"])) // 4), base64.b64decode(live.state["grains"]))
            first = places()
            check(len(first) % 4 == 0 and len(first) > 100 and all(abs(r - 0.01) < 1e-6 for r in first[3::4]), "centres and radii")
            for _ in range(12):
                live.say("step")
            live.next(lambda s: abs(s["t"] - 0.2) < 1e-9)
            fallen = [a - b for a, b in zip(first[2::4], places()[2::4])]
            check(all(abs(d - 9.80665 * 0.02) < 5e-4 for d in fallen), f"{kind}: they have fallen by {fallen[:3]}")
            before = places()
            state = live.set("push", 2)
            check(abs(state["t"] - 0.2) < 1e-9 and max(abs(a - b) for a, b in zip(before, places())) < 1e-6, f"{kind}: they are where they were: {state['t']}, {state['trouble']}")


SLOW = "{type: dynamics, method: rk4, step: 1e-6, duration: 100}"  # minutes


def with_analyses(*analyses, title="one"):
    listed = "".join(f"\n  - {a}" for a in analyses)
    return MODEL.format(title=title, x=0.3).replace(" {type: dynamics, duration: 10}", listed)


def check_endings():
    """What takes long ends when something else is wanted."""
    quick = with_analyses("{type: dynamics, duration: 0.1}", "{type: dynamics, duration: 10}")
    slow = with_analyses(SLOW, "{type: dynamics, duration: 10}", title="two")
    save("long.yaml", quick)
    with Other("long.yaml") as live:
        save("long.yaml", slow)
        time.sleep(0.1)
        version = live.state["version"]
        save("long.yaml", quick.replace("title: one", "title: three").replace("0.3, 0, 0", "0.2, 0, 0"))
        begin = time.monotonic()
        state = live.next(lambda s: s["version"] > version)
        check(time.monotonic() - begin < 5 and state["trouble"] == "", "a saved file ends the reading of the one before")
        save("long.yaml", slow)
        time.sleep(0.1)
    save("long.yaml", with_analyses(SLOW))
    with Other("long.yaml") as live:
        live.say("speed 1000")
        for _ in range(20):
            live.say("step")
        live.say("pause")
        begin = time.monotonic()
        live.say("speed 0.5")
        state = live.next(lambda s: s["speed"] == 0.5)
        check(time.monotonic() - begin < 2 and state["t"] < 10, f"words end a step: {state['t']}")


def check_lists(live):
    """Sliders are known while their numbers change, and one that does not fit takes no other with it."""
    live.say("pause")
    live.say("anew")
    state = live.next(lambda s: s["t"] == 0 and not s["running"])
    number, k = state["list"], live.slider("weight")
    for value in (2.5, 3, 3.5):
        live.say(f"set {number} {k} {value}")
        state = live.next(lambda s, value=value: s["numbers"][k] == value)
    check(state["list"] == number and state["trouble"] == "", "the list stays")
    state = live.set("weight", -1)
    check("weight" in state["trouble"] or "mass" in state["trouble"], f"{state['trouble']}")
    check(state["numbers"][k] == 3.5, f"a mass that cannot be is not kept: {state['numbers']}")
    state = live.set("k", 60)
    check(state["numbers"] == [0, 3.5, 60] and state["trouble"] == "", f"others can be set: {state['numbers']} {state['trouble']}")
    save("model.yaml", MODEL.format(title="wrong", x=0.1).replace("prismatic", "prismatik"))
    live.next(lambda s: "prismatik" in s["trouble"])
    for word in ("step", "run", "pause"):
        live.say(word)
        check("prismatik" in live.next()["trouble"], f"the message stays after {word}")
    save("model.yaml", MODEL.format(title="good", x=0.1))
    live.next(lambda s: s["trouble"] == "")
    live.say("speed 0")
    live.say("run")
    times = [live.next()["t"] for _ in range(10)]
    check(max(b - a for a, b in zip(times, times[1:])) > 1.5, f"as fast as it goes: {times}")
    live.say("speed 1")
    live.say("pause")
    live.say("reset")
    state = live.next(lambda s: s["t"] == 0)
    live.say(f"pull {state['version']} 1 0 0 0 3 0 0")
    live.ask("GET", live.path)  # a page that is opened again
    for _ in range(30):
        live.say("step")
    state = live.next(lambda s: abs(s["t"] - 0.5) < 1e-9)
    check(abs(state["places"][7] - 0.1 * math.cos(2.5)) < 1e-5, f"all steps are made, nothing pulls: {state['places'][7]}")


def check_others():
    """Events, equilibria, what acts while the model stands."""
    stop = "events:\n  - {name: stop, channel: block.position.x, value: 0.2, action: stop}\n"
    save("event.yaml", with_analyses("{type: dynamics, duration: 1}", "{type: dynamics, duration: 10}") + stop)
    with Other("event.yaml") as live:
        check(abs(live.state["values"][0] - 0.2) < 1e-9, f"an event ends the analysis before: {live.state['values']}")
        live.say("speed 8")
        live.say("run")
        live.next(lambda s: "event" in s["trouble"])
        save("other.json", "{}")
        live.say("speed 1")
        check("event" in live.next(lambda s: s["speed"] == 1)["trouble"], "its message stays when another file is saved")
    save("static.yaml", with_analyses("{type: equilibrium}"))
    with Other("static.yaml") as live:
        check([s["name"] for s in live.scene()["sliders"]] == ["push.input", "weight", "k"], "a model that stands has numbers")
        state = live.set("push.input", 5)
        check(abs(state["places"][7] - 0.1) < 1e-6, f"and is where they put it: {state['places'][7]}")
    save("acts.yaml", MODEL.format(title="acts", x=0.3).replace("rail.rate", "block.acceleration.x"))
    with Other("acts.yaml") as live:
        state = live.set("push.input", 100)
        check(abs(state["values"][3] - (100 - 50 * 0.3) / 2) < 1e-4 and state["t"] == 0, f"an effort acts at once: {state['values']}")


def check_folders():
    """Files in folders that were not watched, or that are replaced."""
    part = SPRING.format(k="k")
    inside, aside = os.path.join(folder, "inside"), os.path.join(folder, "aside")
    save("folders.yaml", MODEL.format(title="one", x=0.3))
    with Other("folders.yaml") as live:
        os.mkdir(inside)
        save("inside/one.part", part.replace("tsda", "tsdx"))
        save("folders.yaml", MODEL.format(title="two", x=0.3).replace("spring.part", "inside/one.part"))
        live.next(lambda s: "tsdx" in s["trouble"])
        save("inside/one.part", part)
        live.next(lambda s: not s["trouble"])
        os.rename(inside, aside)
        time.sleep(0.02)
        os.mkdir(inside)
        save("inside/one.part", part.replace("tsda", "tsdy"))
        live.next(lambda s: "tsdy" in s["trouble"])
        save("inside/one.part", part)
        live.next(lambda s: not s["trouble"])


def check_random(live):
    """Requests of which parts are replaced: the server goes on."""
    dice = random.Random(7)
    own = f"Host: 127.0.0.1:{live.port}\r\n"
    seeds = [f"GET {live.path}{what} HTTP/1.1\r\n{own}\r\n" for what in ("", "scene", "state?after=0", "x")]
    seeds += [f"POST {live.path}do HTTP/1.1\r\n{own}Content-Length: {len(w)}\r\n\r\n{w}"
              for w in ("run", "pause", "step", "set 1 1 3", "pull 1 1 0 0 0 0 0 0", "speed 0.5", "release", "reset")]
    seeds += [f"POST {live.path}do HTTP/1.1\r\n{own}Transfer-Encoding: chunked\r\n\r\n3\r\nrun\r\n0\r\n\r\n"]
    for _ in range(requests):
        data = bytearray(dice.choice(seeds).encode())
        for _ in range(dice.choice([0, 1, 1, 3, 20])):
            k = dice.randrange(len(data) + 1)
            kind = dice.randrange(4)
            if kind == 0:
                data[k:k + 1] = bytes([dice.randrange(256)])
            elif kind == 1:
                data[k:k] = bytes(dice.randrange(256) for _ in range(dice.choice([1, 5, 300])))
            elif kind == 2:
                del data[k:k + dice.choice([1, 4, 50])]
            else:
                data[k:k] = dice.choice([b"\r\n", b"\0", b"%00", b"9" * 40, b"Content-Length: 99999999999\r\n", own.encode()])
        status = live.raw(bytes(data))
        if status not in (0, 200, 400, 403, 404, 405, 411, 413, 414, 431, 501, 503, 505):
            check(False, f"{status} for {bytes(data)[:200]}")
    check(live.process.poll() is None, "it lives on")
    check(live.ask("GET", live.path)[0] == 200, "and answers")


def main():
    save("model.yaml", MODEL.format(title="one", x=0.3))
    save("spring.part", SPRING.format(k="k"))
    live = Live(os.path.join(folder, "model.yaml"))
    try:
        check_guards(live)
        check_motion(live)
        check_numbers(live)
        check_saving(live)
        check_lists(live)
        live.say("pause")
        live.next(lambda s: not s["running"])
        before = live.cpu()
        time.sleep(0.3)
        check(live.cpu() - before <= 1, f"{live.cpu() - before} ticks of CPU while nothing happens")
        check_random(live)
        check_turns()
        check_rates()
        check_roads()
        check_grains()
        check_endings()
        check_others()
        check_folders()
        live.process.send_signal(signal.SIGINT)
        check(live.process.wait(10) == 0, f"Ctrl-C ends it: {live.process.returncode}")
    finally:
        live.process.kill()
    print(f"{checks} checks, {failures} failed")
    return failures > 0


sys.exit(main())
