# make test   set up what is needed, and run the whole test suite
# make test-rclpy   run the graph tests with rclpy's own executor instead of ours
# make demo   watch the node drive a simulated base; PHYSICS=mujoco: on tyres that slip
# make accuracy   measure the error of the odometry, and of the common method
# make physics   measure what our commands, and WPILib's recipe, do to tyres and motors
# make bench   measure the cost of node and core, and of an empty node, WPILib and numpy
# make docs   build pages and API reference as HTML in docs-output; any warning is an error
# make pictures   redraw the pictures of the pages
#
# ROS 2 is used where it is installed; otherwise it comes from PyPI into .venv. Every target takes
# ROS_DISTRO=kilted to use ROS 2 Kilted instead of Jazzy, in an environment of its own.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c

ROS_DISTRO ?= jazzy
ROS_SETUP := $(wildcard /opt/ros/$(ROS_DISTRO)/setup.bash)
# A ROS that is installed but not sourced is sourced in each recipe. Its scripts use unset names.
SOURCE_ROS := $(if $(AMENT_PREFIX_PATH),:,$(if $(ROS_SETUP),set +u; source $(ROS_SETUP); set -u,:))
HAS_ROS := $(shell $(SOURCE_ROS); python3 -c 'import rclpy, nav_msgs' 2>/dev/null && echo yes)

IS_JAZZY := $(filter jazzy,$(ROS_DISTRO))
VENV := $(if $(IS_JAZZY),.venv,.venv-$(ROS_DISTRO))
ROS_EXTRA := $(if $(IS_JAZZY),ros,$(ROS_DISTRO))
READY := $(VENV)/.ready
PYTHON := $(VENV)/bin/python

.PHONY: test test-rclpy demo accuracy physics bench docs pictures clean

# Plugins that ROS or colcon bring along are not ours, and not made for every pytest. Tests of the
# graph mostly wait: run three at a time, each process in a domain of its own.
IN_PARALLEL := -p xdist.plugin -n 3
# Programs are started some hundreds of times: Python shall keep what it compiles for them.
export PYTHONDONTWRITEBYTECODE :=

test: $(READY)
	$(SOURCE_ROS); PYTEST_DISABLE_PLUGIN_AUTOLOAD=1 $(PYTHON) -m pytest $(IN_PARALLEL)

test-rclpy: $(READY)
	$(SOURCE_ROS); SWERVE_KINEMATICS_EXECUTOR=rclpy PYTEST_DISABLE_PLUGIN_AUTOLOAD=1 \
	    $(PYTHON) -m pytest $(IN_PARALLEL) test/ros test/sim

# The demo needs nothing beyond ROS, and matplotlib for its picture.
RUN_DEMO := from swerve_kinematics.programs import swerve_demo; raise SystemExit(swerve_demo())
ifeq ($(HAS_ROS),yes)
demo:
	$(SOURCE_ROS); python3 -c '$(RUN_DEMO)' $(if $(PHYSICS),--physics $(PHYSICS))
else
demo: $(READY)
	$(PYTHON) -c '$(RUN_DEMO)' $(if $(PHYSICS),--physics $(PHYSICS))
endif

accuracy: $(READY)
	$(SOURCE_ROS); PYTHONPATH=test$${PYTHONPATH:+:$${PYTHONPATH}} $(PYTHON) -m benchmarks.accuracy

physics: $(READY)
	$(SOURCE_ROS); $(PYTHON) test/benchmarks/physics.py

bench: $(READY)
	$(SOURCE_ROS); $(PYTHON) test/benchmarks/bench.py

# Not part of the tests: it takes too long.
docs: $(VENV)/.docs
	$(PYTHON) -m sphinx --fail-on-warning --keep-going --nitpicky --quiet docs docs-output
	@echo "open docs-output/index.html"

$(VENV)/.docs: $(READY)
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --editable ".[docs]"
	touch $@

pictures: $(READY)
	$(SOURCE_ROS); $(PYTHON) docs/pictures.py

# With ROS on the machine the environment sees its packages; else, and where it does not, it
# gets its own.
$(READY): setup.py
	$(SOURCE_ROS); python3 -m venv --clear $(if $(HAS_ROS),--system-site-packages) $(VENV)
	$(SOURCE_ROS); ros=$$($(PYTHON) -c 'import rclpy, nav_msgs' 2>/dev/null || echo $(ROS_EXTRA),); \
	    $(PYTHON) -m pip install --quiet --disable-pip-version-check \
	    --editable ".[$${ros}tools,calibration,physics,test]"
	touch $@

clean:
	rm -rf .venv .venv-* build install log demo-output bench-output docs-output
