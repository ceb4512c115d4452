# Copyright 2026 swerve_kinematics maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Settings for the whole suite, and fixtures for tests on a real graph of its own."""

from functools import partial
import gc
from importlib.metadata import version
import itertools
import os
from pathlib import Path
import signal

from hypothesis import settings
import pytest

# Traffic stays on this machine, and apart from other graphs on it. Must be set before rclpy
# is loaded; the processes that tests start inherit it. Domains up to 101 are safe on Linux.
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)
# Half of all programs are not found by their first announcements, and else only 3 s later. Kilted,
# with rclpy 9, warns of the name that Fast DDS had in Jazzy.
FAST_DDS = 'FASTDDS' if int(version('rclpy').partition('.')[0]) >= 9 else 'FASTRTPS'
os.environ[f'{FAST_DDS}_DEFAULT_PROFILES_FILE'] = str(Path(__file__).with_name('discovery.xml'))
# Our matrices are too small to share: threads that wait for one only take processors from tests.
os.environ['OPENBLAS_NUM_THREADS'] = '1'

settings.register_profile('suite', derandomize=True, deadline=None)
settings.load_profile('suite')

# Their tests take longest: they must not be left to one process when the others are done.
LONGEST = 'test_swerve_check_live.py', 'test_package.py'
NAMESPACES = (f'/robot_{index}' for index in itertools.count())


def pytest_collection_modifyitems(items):
    """Begin with the tests that take longest."""
    items.sort(key=lambda item: item.path.name not in LONGEST)


def pytest_collection_finish():
    """Spare the garbage collector what lives as long as the process: modules and tests."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope='session')
def context():
    """Initialise rclpy once for the test process."""
    import rclpy
    rclpy.init()
    yield
    rclpy.try_shutdown()


@pytest.fixture
def namespace():
    """Return a namespace that no other test uses."""
    return next(NAMESPACES)


@pytest.fixture
def client(context, namespace):
    """Return a client in the test's namespace."""
    from graph import Client
    client = Client(namespace)
    yield client
    client.close()


@pytest.fixture
def reports(client, namespace):
    """Return the list that each DiagnosticStatus of this test's node is appended to."""
    from diagnostic_msgs.msg import DiagnosticArray
    statuses = []
    client.node.create_subscription(
        DiagnosticArray, '/diagnostics',
        lambda m: statuses.extend(s for s in m.status if s.name.startswith(f'{namespace}/')), 10)
    return statuses


@pytest.fixture(params=['PersistentExecutor', 'SingleThreadedExecutor'])
def graph(request):
    """Return an ExecutorGraph with either executor, ours or rclpy's."""
    from executor_graph import ExecutorGraph
    from rclpy.executors import SingleThreadedExecutor
    from swerve_kinematics.ros.executor import PersistentExecutor
    kinds = (PersistentExecutor, SingleThreadedExecutor)
    graph = ExecutorGraph({kind.__name__: kind for kind in kinds}[request.param])
    yield graph
    graph.close()


@pytest.fixture(scope='session')
def leaving():
    """Return the list of programs that were told to end, which they must do by themselves."""
    programs = []
    yield programs
    for program in programs:
        program.end()


@pytest.fixture
def start(namespace, tmp_path, leaving):
    """Return a function that starts a program in the namespace; it is ended with the test."""
    from graph import Program
    programs = []

    def start_program(module, *ros_arguments, namespace=namespace, **parameters):
        log = tmp_path / f'program_{len(programs)}.log'
        programs.append(Program(module, namespace, ros_arguments, parameters, log))
        return programs[-1]

    yield start_program
    # They take their time to say goodbye, in a namespace of their own: let the next test begin.
    for program in programs:
        program.send(signal.SIGINT)
        print(program.output)  # pytest shows it if the test failed
    leaving += programs


@pytest.fixture
def start_node(start):
    """Return a function that starts swerve_node with arguments and parameters."""
    return partial(start, 'swerve_kinematics.ros.node')


@pytest.fixture
def start_sim(start):
    """Return a function that starts swerve_sim with arguments and parameters."""
    return partial(start, 'swerve_kinematics.sim.node')
