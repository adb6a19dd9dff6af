# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""Makes the pictures of docs/how-to/replay.md and live.md: pictures.py BBSIM SOURCE FOLDER"""

import os
import sys
import time

folder = os.path.abspath(sys.argv[3])
from in_browser import BBSIM, files  # noqa: E402: it reads the command line
from test_replay import Comparison  # noqa: E402
from webdriver import Browser, small_png  # noqa: E402


def take(name, page, script, width, height, wait=0, **options):
    with Browser(width, height, **options) as browser:
        browser.open(page)
        browser.run(script)
        time.sleep(wait)
        browser.frame()
        browser.frame()
        with open(os.path.join(folder, name + ".png"), "wb") as picture:
            picture.write(small_png(browser, browser.picture()))


os.makedirs(folder, exist_ok=True)
take("replay-rig", files.scene("rig"), "bbsim.seek(12.4)", 1100, 700)
take("replay-falls", files.scene("falls"), "bbsim.seek(9)", 1100, 700, dark=True)
take("replay-phone", files.scene("fig2b"), "bbsim.seek(3)", 400, 800, phone=True)
take("replay-compare", Comparison().page(), "bbsim.seek(1.2)", 1100, 700)
gains, _ = files.sweep("map", "fig2b", "--vary", "controller.pd.kv.0.0=linear:0.2:4:31", "--vary",
                       "controller.pd.kp.0.0=linear:0:8:25")
take("replay-sweep", gains, "bbsim.sweeps[0].choose(134)", 1100, 700)
if os.path.exists(os.path.join(os.path.dirname(BBSIM), "../share/bbsim/engine.html")):
    take("live", files.scene("fig2b", "--live"),
         "bbsim.live.set('controller.reference.circle.radius', '8 cm').then(() => bbsim.seek(12.4))", 1100, 700, wait=5)
