"""The picture of a swerve base and what a twist asks of its modules."""

from typing import NamedTuple

import numpy as np

from swerve_kinematics.core.drawing import outline, twist_parts, velocity_vectors
from swerve_kinematics.core.kinematics.modules import optimize
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

ASKED, REVERSED, TRANSLATION, ROTATION = '#16a34a', '#dc2626', '#3b82f6', '#d2b48c'
REVERSED_FILL, BASE, WHEEL, CENTER = '#fee2e2', '#8a94a3', '#374151', '#c026d3'
# Width of an arrow's shaft as a share of the picture's.
THICK, THIN = 0.008, 0.005
# Shares of the base's radius: sides of a wheel, the arrow of the fastest module, and from the
# middle to the labels, which it does not reach, and to the edge of the picture.
WHEEL_LENGTH, WHEEL_WIDTH, ARROW, LABEL, REACH = 0.28, 0.10, 0.8, 2.05, 2.5
# A slower module [m/s] has no arrow.
MIN_SPEED = 1e-3


class Base(NamedTuple):
    """
    What is drawn.

    Attributes
    ----------
    names : tuple of str (n,)
        Of the modules.
    kinematics : SwerveKinematics

    """

    names: tuple
    kinematics: SwerveKinematics

    @property
    def positions(self):
        """Return where the modules are, shape (n, 2), from base_link [m]."""
        return self.kinematics.module_positions

    @property
    def middle(self):
        """Return the point [m] around which the modules stand."""
        return self.positions.mean(axis=0)

    @property
    def radius(self):
        """Return how far [m] the farthest module is from the middle."""
        return np.hypot(*(self.positions - self.middle).T).max()


def asked_states(kinematics, twist, center, angles):
    """
    Return what the modules are asked, each turned by 90 degrees at most.

    Parameters
    ----------
    kinematics : SwerveKinematics
        Of the base.
    twist : array_like (3,)
        `[vx, vy, omega]` [m/s, m/s, rad/s] of the centre of rotation.
    center : array_like (2,)
        From base_link [m].
    angles : array_like (n,)
        Where the modules are [rad].

    Returns
    -------
    ModuleStates (n,)

    """
    return optimize(kinematics.inverse(twist, center, held_angles=angles), angles)


def draw(axes, base, twist, center, states, arrow_time):
    """
    Draw a base with the vectors of its modules.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Cleared first.
    base : Base
        Layout and names of the modules.
    twist : array_like (3,)
        `[vx, vy, omega]` [m/s, m/s, rad/s] of the centre of rotation.
    center : array_like (2,)
        From base_link [m].
    states : ModuleStates (n,)
        What the modules are asked.
    arrow_time : float
        An arrow is as long as the way [s] its module goes in this time.

    """
    axes.clear()
    _draw_base(axes, base, states)
    translation, rotation = twist_parts(base.positions, twist, center)
    asked = velocity_vectors(states)
    _draw_parallelograms(axes, base.positions, arrow_time * translation, arrow_time * asked)
    is_reversed = states.speed < 0.0
    for label, chosen, vectors, style in (
            ('translation', slice(None), translation, {'color': TRANSLATION, 'width': THIN}),
            ('rotation', slice(None), rotation, {'color': ROTATION, 'width': THIN}),
            ('asked', ~is_reversed, asked, {'color': ASKED, 'width': THICK}),
            ('asked, drive reversed', is_reversed, asked,
             {'facecolor': REVERSED_FILL, 'edgecolor': REVERSED, 'width': THICK,
              'linewidth': 1.5, 'linestyle': (0, (3.0, 1.5))})):
        _draw_arrows(axes, label, base.positions[chosen], arrow_time * vectors[chosen],
                     arrow_time * MIN_SPEED, style)
    _label_modules(axes, base, states)
    axes.plot(*center, 'P', color=CENTER, markersize=10, markeredgecolor='white',
              linestyle='none', zorder=6, label='centre of rotation')
    _frame(axes, base, center, twist)


def _draw_base(axes, base, states):
    """Draw the outline, the wheels and where the front is."""
    axes.fill(*outline(base.positions).T, facecolor='#f3f4f6', edgecolor=BASE, linewidth=1.2,
              zorder=0)
    half_length, half_width = 0.5 * WHEEL_LENGTH * base.radius, 0.5 * WHEEL_WIDTH * base.radius
    corners = np.array([(1, 1), (1, -1), (-1, -1), (-1, 1)]) * (half_length, half_width)
    for position, angle in zip(base.positions, states.angle):
        along = np.array((np.cos(angle), np.sin(angle)))
        turned = corners @ np.stack((along, (-along[1], along[0])))
        axes.fill(*(position + turned).T, color=WHEEL, zorder=2)
    nose = 0.15 * base.radius
    axes.plot([0.0, nose, np.nan, 0.0, 0.0], [0.0, 0.0, np.nan, 0.0, nose], color=BASE,
              linewidth=1.5, zorder=1)
    axes.annotate('base_link', (0.0, 0.0), (-4, -4), textcoords='offset points', color=BASE,
                  ha='right', va='top', fontsize=8)


def _draw_parallelograms(axes, positions, translation, asked):
    """Draw that the two parts add up."""
    for position, part, whole in zip(positions, translation, asked):
        corners = position + np.stack((part, whole, whole - part))
        axes.plot(*corners.T, ':', color=BASE, linewidth=0.9, zorder=1)


def _draw_arrows(axes, label, positions, vectors, shortest, style):
    """Draw arrows [m] from the modules, none for those that are shorter than `shortest` [m]."""
    is_drawn = np.hypot(*vectors.T) > shortest
    if is_drawn.any():
        axes.quiver(*positions[is_drawn].T, *vectors[is_drawn].T, angles='xy',
                    scale_units='xy', scale=1.0, label=label, minlength=0.0, zorder=4, **style)


def _label_modules(axes, base, states):
    """Write name, speed and angle of each module, outside of the base."""
    for name, position, speed, angle in zip(base.names, base.positions, *states):
        axes.text(*(base.middle + LABEL * (position - base.middle)),
                  f'{name}\n{speed:.2f} m/s @ {np.degrees(angle):.0f}°', fontsize=9,
                  ha='center', va='center', zorder=3)


def _frame(axes, base, center, twist):
    """Set title, limits, grid and legend."""
    vx, vy, omega = twist
    axes.set_title(f'vx {vx:.2f} m/s   vy {vy:.2f} m/s   omega {omega:.2f} rad/s', pad=12)
    reach = max(REACH * base.radius, 1.1 * np.abs(center - base.middle).max())
    for set_limits, middle in ((axes.set_xlim, base.middle[0]), (axes.set_ylim, base.middle[1])):
        set_limits(middle - reach, middle + reach)
    axes.set_aspect('equal')
    axes.grid(alpha=0.25)
    axes.set_axisbelow(True)
    axes.set_xlabel('x [m], forward')
    axes.set_ylabel('y [m], left')
    axes.legend(loc='upper center', ncols=5, frameon=False, fontsize=9,
                bbox_to_anchor=(0.5, -0.09))
