# SPDX-License-Identifier: GPL-3.0-or-later
# The commands of this project. Each one sets up what it needs first; the work is in tools/*.py.
PYTHON ?= python3

.PHONY: help demo test build lint format stubs extension asan tsan nightly setup clean

help:            ## list the commands
	@sed -n 's/^\([a-z]*\): *## /make \1  - /p' $(MAKEFILE_LIST)

demo:            ## render scenes/blender/cornell_glass.blend through Blender into out/
	@$(PYTHON) tools/demo.py

test:            ## run everything (STAGES="lint native" picks some)
	@$(PYTHON) tools/run_tests.py $(STAGES)

build:           ## compile build/renderer and the C++ tests
	@$(PYTHON) tools/run_tests.py native --build-only

lint:            ## formatters, types and the layer check
	@$(PYTHON) tools/run_tests.py lint

format:          ## apply the formatters
	@$(PYTHON) tools/lint.py --fix

stubs:           ## generate native/python/basicrt/_native.pyi again
	@$(PYTHON) tools/generate_stubs.py

extension:       ## make the installable Blender extension in dist/
	@$(PYTHON) tools/build_extension.py

asan:            ## C++ tests under the address and undefined-behaviour sanitizers
	@$(PYTHON) tools/run_tests.py asan

tsan:            ## C++ tests under the thread sanitizer
	@$(PYTHON) tools/run_tests.py tsan

nightly:         ## the comparison with Cycles over scenes/blender/families.py, on pictures four times as wide and high, and 500 sequences of edits
	@BASICRT_BIAS_SCALE=4 BASICRT_EDIT_SEQUENCES=500 $(PYTHON) tools/run_tests.py wheels blender-5.0

setup:           ## only install what the other commands need
	@$(PYTHON) tools/bootstrap.py

clean:           ## remove what was built (not the virtual environments)
	rm -rf build build-* dist out
