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

"""Package swerve_kinematics: `colcon build` on a ROS machine, `pip install` elsewhere."""

from glob import glob
from pathlib import Path
import re

from setuptools import find_packages, setup

NAME = 'swerve_kinematics'
# Read, not imported: that would need numpy to build the package.
VERSION = re.search(r"^__version__ = '(.+)'$",
                    Path(__file__).with_name(NAME).joinpath('__init__.py').read_text(),
                    re.MULTILINE)[1]


def wheels_of(distribution):
    """Return the packages on PyPI that bring what the node needs of a ROS 2 distribution."""
    return [f'ros-{distribution}-{name}'
            for name in ('rclpy', 'rmw-fastrtps-cpp', 'common-interfaces')]


setup(
    name=NAME,
    version=VERSION,
    description='Swerve-drive kinematics, command shaping and odometry for ROS 2',
    long_description=Path(__file__).with_name('README.md').read_text(),
    long_description_content_type='text/markdown',
    maintainer='swerve_kinematics maintainers',
    maintainer_email='maintainers@example.org',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={NAME: ['py.typed']},
    python_requires='>=3.10',
    install_requires=['setuptools', 'numpy>=1.26', 'pyyaml'],
    extras_require={
        # ROS 2 without a ROS installation: Jazzy, or Kilted.
        'ros': wheels_of('jazzy'),
        'kilted': wheels_of('kilted'),
        # Pictures: the demo's and swerve_visualize.
        'tools': ['matplotlib'],
        # Bags: swerve_calibrate reads CSV without it.
        'calibration': ['rosbags'],
        # Rigid-body physics for swerve_sim.
        'physics': ['mujoco'],
        # Pages and API reference: make docs.
        'docs': ['myst-parser', 'numpydoc', 'sphinx'],
        'test': [
            'colcon-common-extensions',  # the package must build as users build it
            # What ament_flake8 and ament_pep257 check.
            'flake8', 'flake8-builtins', 'flake8-comprehensions', 'flake8-docstrings',
            'flake8-import-order', 'flake8-quotes',
            'hypothesis',
            'mypy', 'types-PyYAML',
            'pytest', 'pytest-xdist',
            'robotpy-wpimath',  # the reference that the kinematics are checked against
        ],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/config', glob('config/*')),
        (f'share/{NAME}/launch', glob('launch/*.launch.py')),
    ],
    entry_points={
        'console_scripts': [
            f'swerve_node = {NAME}.programs:swerve_node',
            f'swerve_sim = {NAME}.programs:swerve_sim',
            f'swerve_demo = {NAME}.programs:swerve_demo',
            f'swerve_visualize = {NAME}.programs:swerve_visualize',
            f'swerve_calibrate = {NAME}.programs:swerve_calibrate',
            f'swerve_check = {NAME}.programs:swerve_check',
        ],
    },
    zip_safe=False,  # a type checker does not look for py.typed in a zip
)
