"""Times what comes before the first step, in a process of its own: prepare.py SPEC prints JSON."""

import json
import sys
import time
from dataclasses import replace
from pathlib import Path

began = time.perf_counter()
from gaitsim.parts.find import Library, library_folders  # noqa: E402
from gaitsim.simulation.run import Simulator  # noqa: E402
from gaitsim.spec.resolve import read_spec, resolve  # noqa: E402

imported = time.perf_counter()
path = Path(sys.argv[1])
model = resolve(read_spec(path, []), Library(library_folders(path)), path.stem)
resolved = time.perf_counter()
# Kernels and the loop are loaded by the first run, so a run of one step belongs to preparing.
one_step = replace(model, simulate=replace(model.simulate, duration=model.simulate.step))
Simulator(one_step).run()
prepared = time.perf_counter()
print(json.dumps([imported - began, resolved - imported, prepared - resolved]))
