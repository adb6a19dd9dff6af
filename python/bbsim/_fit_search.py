# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The values of keys at which a model is closest to logs, and how well the logs determine them."""

from __future__ import annotations

import math
from typing import Any, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy.optimize import least_squares, lsq_linear
from scipy.special import stdtrit

from . import _bbsim
from ._fit_windows import KEY_STEP, WIDE, LogKey, WindowsFit
from ._scenario import Array
from ._task import FreeKey, Progress, refuse_free, silent

_HUBER = 1.345  # standard deviations; costs 5 % of the efficiency for Gaussian noise
_KINKED_STARTS = 3
_UNTOLD = 1e-4  # of the largest singular value; smaller ones are errors of differences
_WIDEST = 0.3  # of the steps of a key's number
_SCANNED, _DELAYS = 201, 0.2  # delays in a scan, and how far it goes without bounds (s)
_HOPS, _DRAWS, _WIDER = 40, 20, (0.3, 1, 3, 10, 30)  # over jumps: the most; draws for each multiple of the deviations


class _Done(Exception):
    """The sum of squares has no more to give."""


class Search:
    """`u`: the best numbers of the keys so far."""

    def __init__(self, windows: WindowsFit, robust: bool, progress: Progress) -> None:
        self.windows, self.keys, self.robust, self.progress = windows, windows.keys, robust, progress
        self.u, self.iterations = np.zeros(len(windows.keys)), 0
        values = [windows.measured[windows.there & (windows.column_of == c)] for c in range(len(windows.columns))]
        # Differences below 1e-9 of a column's spread are rounding.
        self.spreads = np.array([max(float(np.std(its)), 1e-9) if its.size else 1.0 for its in values])
        self.doubts: List[str] = []  # why the estimates may be wrong
        self.rivals = np.empty((0, len(self.u)))
        self.bounds = windows.bounds
        # The keys that are delays of commands which a servo with a dead band follows, or which are rounded.
        self.delays = [k for k, key in enumerate(self.keys) if windows.jumps and not windows.deaf[:, k].all()
                       and key.name.startswith("controller.commands") and key.name.endswith("delay")]  # fmt: skip
        windows.reweigh(self.spreads)

    def degrees_of_freedom(self) -> float:
        return max(1.0, float(self.windows.size - self.windows.starts_rank() - len(self.keys)))

    def scale_keys(self) -> Array:
        """Reduces the scale of each key that changes the logs by more than ten times the noise: such differences would
        be those of another rig. Returns the change of the logs for each scale, over the noise."""
        for rounds in range(8):
            changes = self.windows.derivatives(self.u, near=not rounds)[1] / math.sqrt(self.windows.size)
            large = [k for k, key in enumerate(self.keys) if not key.logarithmic and self.u[k] == 0 and changes[k] > 10]
            if not large:
                break
            for k in large:
                self.keys[k].scale /= changes[k]
        return changes

    def minimize(self, exact: bool) -> None:
        """Moves u to the nearby least sum of squares. Directions that the logs do not determine stay."""
        first, windows, (low, high) = self.u.copy(), self.windows, self.bounds()
        jacobian, norms = windows.derivatives(first)
        sizes = np.maximum(norms, 1e-300)
        _, values, directions = np.linalg.svd(jacobian / sizes, full_matrices=False)
        # Rows that hold those directions: as strong as the best known one.
        weak = np.where(values[:, None] > _UNTOLD * values[0], 0.0, values[0] * directions * sizes)

        def residuals(x: Array) -> Array:
            return np.concatenate([windows.residuals(first + x - 1), weak @ (x - 1)])

        def derivatives(x: Array) -> Array:
            u = first + x - 1
            self._advance(u)
            rest, slopes = residuals(x), np.concatenate([windows.derivatives(u)[0], weak])
            step, gain = _best_step(slopes, rest, u <= low, u >= high)
            variance = np.mean(rest**2)
            # Those of a point more than 3 % of a standard deviation away?
            away = slopes[: -len(u)] @ (u - windows.base.u)
            if exact and gain < variance and float(np.linalg.norm(away)) ** 2 > 1e-3 * self.scatter():
                slopes[: -len(u)] = windows.derivatives(u, near=False)[0]
                step, gain = _best_step(slopes, rest, u <= low, u >= high)
            if gain <= (1e-5 if exact else 0.1) * variance:  # SciPy would look for a decrease among rounding errors
                self.u = np.clip(u + step, low, high)
                raise _Done
            return slopes

        # x begins at 1: the trust region is then as large as a key's number at the start.
        try:
            ends = (np.minimum(low - first, 0) + 1, np.maximum(high - first, 0) + 1)
            found = least_squares(residuals, np.ones(len(first)), derivatives, ends, "dogbox", ftol=1e-13, xtol=1e-9,
                                  gtol=None, max_nfev=100)  # fmt: skip
            self._advance(first + found.x - 1)
        except _Done:
            pass

    def minimize_together(self, most: int = 40) -> None:
        """Keys and starts side by side, where residuals have kinks, and starts that follow the keys would be lost."""
        windows, count = self.windows, len(self.u)
        windows.residuals(self.u)
        x = np.concatenate([self.u, windows.point.starts[:, windows.free].ravel()])

        def move(x: Array, derivatives: bool) -> Array:
            starts = windows.point.starts.copy()
            starts[:, windows.free] = x[count:].reshape(-1, len(windows.free))
            return windows.at(x[:count], starts, derivatives)

        def slopes(x: Array) -> Array:
            self.u = x[:count]
            move(x, True)
            self._advance(self.u)
            return windows.side_by_side()

        low, high = self.bounds()
        ends = [np.concatenate([end, np.full(len(x) - count, sign * np.inf)]) for end, sign in ((low, -1), (high, 1))]
        found = least_squares(lambda x: move(x, False), x, slopes, ends, "trf", ftol=1e-5, xtol=1e-8, gtol=None,
                              x_scale="jac", max_nfev=most)  # fmt: skip
        self.u = found.x[:count]
        move(found.x, True)

    def _advance(self, u: Array) -> None:
        self.u, self.iterations = u, self.iterations + 1
        rms = _bbsim.rounded(math.sqrt(float(np.mean(self.windows.residuals(u) ** 2))), 4)
        self.progress(self.iterations / (self.iterations + 5), f"iteration {self.iterations}, rms residual {rms} noise")

    def begin(self, starts: Optional[int]) -> None:
        changes, known = self.scale_keys(), self.windows.deaf.all(0)
        known |= self._begin_at_delays()
        self.windows.find_kinks(self.u)
        if self.windows.kinked:
            changes = self.windows.derivatives(self.u)[1]
        for key, change, acts in zip(self.keys, changes, known):
            if not (change > 1e-7 or acts):
                columns = ", ".join(self.windows.columns)
                refuse_free(f"{key.name}: has no effect on {columns}; allowed: keys that the compared columns depend on")
        # Mirrors the scale of a sensor if that fits better: between 1 and -1 it would pass 0, where the log determines
        # no other key.
        for k, key in enumerate(self.keys):
            if isinstance(key, LogKey) and key.of == "scale" and not key.logarithmic and -key.start >= key.lower:
                cost, before = self.cost(), self.u
                self.u = np.where(np.arange(len(before)) == k, key.number(-key.start), before)
                self.windows.restart()  # the slopes by the starts are mirrored, too
                self.u = self.u if self.cost() < cost else before
                self.windows.restart()
        count = starts or (_KINKED_STARTS if self.windows.kinked else 1)
        if count > 1:
            self._try_starts(count)

    def _scans(self) -> Iterator[Tuple[int, Array, Array]]:
        """For each delay, numbers within its bounds, and sums of squares there with the other keys as they are. Which
        commands a servo follows, or how they are rounded, changes in steps with the delay: residuals have a valley for
        each period of the samples, or are flat between two steps."""
        for k in self.delays:
            key, bounds = self.keys[k], self.bounds()[:, k]
            limits = float(key.value(self.u[k])) + np.array([-_DELAYS, _DELAYS])
            ends = np.where(np.isfinite(bounds), bounds, [*map(key.number, limits)])
            many = np.tile(self.u, (_SCANNED, 1))
            many[:, k] = np.linspace(ends[0], ends[1], _SCANNED)
            yield k, many[:, k], self.windows.tried(many, False)[2]

    def _begin_at_delays(self) -> Array:
        """Moves to the best delays of scans. Returns which keys have an effect in them."""
        acts = np.zeros(len(self.u), bool)
        for _ in self.delays:  # once more for each other delay
            for k, at, costs in self._scans():
                acts[k] |= np.ptp(costs) > 1e-7 * costs.min()
                if costs.min() < self.cost() * (1 - 1e-4):
                    self.u = np.where(np.arange(len(self.u)) == k, at[costs.argmin()], self.u)
                    self.windows.restart()
                    self.windows.residuals(self.u)
        return acts

    def compare_delays(self) -> None:
        """Finds other delays that fit as well: they count for the intervals, and as doubts."""
        for k, at, costs in self._scans():
            near = at[costs <= self.cost() * (1 + 4 / self.degrees_of_freedom())]
            others = np.tile(self.u, (len(near), 1))
            others[:, k] = near
            self.rivals = np.concatenate([self.rivals, others])
            if len(near) > 1:
                low, high = (_bbsim.short_number(float(self.keys[k].value(end))) for end in near[[0, -1]])
                self.doubts.append(f"{self.keys[k].name}: values from {low} to {high} fit equally well: between them, "
                                   "the servos follow the same commands")  # fmt: skip

    def _try_starts(self, count: int, ends: Sequence[Tuple[float, Array, Array]] = ()) -> None:
        """Continues from the best of several starts, or of what is known; the first start is the present one."""
        bounds = self.bounds()
        # Without bounds: a factor of two, or the key's scale.
        reach = np.array([math.log(2) if key.logarithmic else 1.0 for key in self.keys])
        low, high = np.where(np.isfinite(bounds[1] - bounds[0]), bounds, [self.u - reach, self.u + reach])
        low, high = np.where(self.windows.deaf.all(0), self.u, [low, high])
        random, first, ends = np.random.default_rng(1), self.u, list(ends)
        for start in range(count):
            self.u = low + (high - low) * random.uniform(size=len(first)) if start else first
            self.windows.restart()
            self.descend()
            ends.append((self.cost(), self.u, self.windows.point.starts))
        ends.sort(key=lambda end: end[0])
        _, self.u, its = ends[0]
        self.windows.at(self.u, its, True)
        if self.windows.kinked:
            self._compare(ends)

    def descend(self, most: int = 40) -> None:
        """To the nearby least sum of squares, roughly."""
        if self.windows.kinked:
            self.windows.at(self.u, self.windows.guess_velocities(self.u), True)
            self.minimize_together(most)
        else:
            self.minimize(False)

    def _compare(self, ends: Sequence[Tuple[float, Array, Array]]) -> None:
        """Says if starts end at different values."""
        near = [u for cost, u, _ in ends if cost <= ends[0][0] * (1 + 4 / self.degrees_of_freedom())]
        self.rivals = np.array(near)
        for k, key in enumerate(self.keys):
            values = key.value(self.rivals[:, k])
            low, high = (_bbsim.short_number(float(end)) for end in (values.min(), values.max()))
            if len(near) == 1:
                if k in self.delays:  # the scan has compared all of its values
                    continue
                others = ", ".join(_bbsim.short_number(float(key.value(u[k]))) for _, u, _ in ends[1:])
                self.doubts.append(f"{key.name}: other starts end at {others}, with larger residuals; the residuals "
                                   "have kinks, and a better fit may exist")  # fmt: skip
            elif np.ptp(values) > 0.02 * max(abs(values.max()), abs(key.scale)):
                self.doubts.append(f"{key.name}: starts end at values from {low} to {high} that fit equally well")

    def settle(self) -> None:
        """Finds the keys with weights that follow the residuals."""
        windows = self.windows
        self._reweigh_often()
        if not windows.jumps:
            return
        if not windows.kinked:
            # The start may lie between two jumps, and the end at one.
            windows.find_kinks(self.u, np.clip(self._sizes(), WIDE * KEY_STEP, _WIDEST))
            if not windows.kinked:
                return
            self._try_starts(_KINKED_STARTS, [(self.cost(), self.u, windows.point.starts)])
            self._reweigh_often()
        random, in_vain, first = np.random.default_rng(1), 0, windows.key_steps
        for turn in range(_HOPS):
            # Wide steps see where many jumps lead, small ones where none is.
            windows.key_steps = np.full(len(self.u), _WIDEST / 3.0 ** (turn % 4))
            in_vain = 0 if self._hop(random) else in_vain + 1
            if in_vain == 4:
                break
            if not in_vain:
                self._reweigh_often()
        windows.key_steps = first
        for _ in range(3):  # the slopes that count are those over the deviations that they give
            windows.key_steps = np.sqrt(windows.key_steps * np.clip(self._sizes(), KEY_STEP, _WIDEST))

    def _sizes(self) -> Array:
        """The deviations of the keys' numbers; infinite if the logs do not determine them."""
        linear = self.linear()
        return np.where(linear.told, np.sqrt(np.diag(linear.covariance) * self.scatter()), np.inf)

    def _hop(self, random: np.random.Generator) -> bool:
        """Moves u over jumps, which end a descent, to a better point, if there is one among draws from the estimates'
        distribution and from wider ones."""
        linear = self.linear()
        covariance = np.where(np.outer(linear.told, linear.told), linear.covariance * self.scatter(), 0.0)
        covariance += np.diag(np.where(linear.told, 0.0, self.windows.key_steps**2))
        draws = random.multivariate_normal(np.zeros(len(self.u)), covariance, _DRAWS * len(_WIDER), method="eigh")
        draws *= np.repeat(_WIDER, _DRAWS)[:, None] * ~self.windows.deaf.all(0)
        many, starts, costs = self.windows.tried(np.clip(self.u + draws, *self.bounds()), True)
        best = int(costs.argmin())
        if not costs[best] < self.cost() * (1 - 1e-4):
            return False
        self.u = many[best]
        self.windows.at(self.u, starts[best], True)
        return True

    def _reweigh_often(self) -> None:
        change = 1.0
        for _ in range(4 if self.windows.kinked else 40 if self.robust else 12):
            if self.windows.kinked:
                self.minimize_together()
            else:
                self.minimize(change < 0.01)
            last, change = change, self._reweigh()
            if self.windows.kinked and change < 0.01 or last < 0.01 and change < (1e-4 if self.robust else 1e-5):
                break

    def _reweigh(self) -> float:
        """Estimates each column's noise from its residuals. Returns how much weights change."""
        windows = self.windows
        residuals, (rms, usual, _) = windows.residuals(self.u), windows.sizes()
        share = self.degrees_of_freedom() / windows.size
        noise = np.maximum((usual if self.robust else rms) / math.sqrt(share), 1e-9 * self.spreads)
        changes, weights, most = noise / windows.noise, None, 0.0
        if self.robust:
            weights = np.ones(windows.weights.shape)
            size = np.abs(residuals) / windows.weights[windows.there]
            weights[windows.there] = np.sqrt(np.minimum(1, _HUBER / np.maximum(size, 1e-300)))
            most = float(np.abs(weights - windows.weights).max())
        windows.reweigh(noise, weights)
        return max(most, float(changes.max() / changes.min() - 1))

    def scatter(self) -> float:
        """The variance of a residual over the noise; with Huber's loss, that of its influence (Huber, Robust
        Statistics, 1981, section 7.6)."""
        residuals = self.windows.residuals(self.u)
        weights = self.windows.weights[self.windows.there]
        variance = float(((residuals * (weights if self.robust else 1)) ** 2).sum()) / self.degrees_of_freedom()
        return variance / max(float(np.mean(weights >= 1)), 0.1)

    def suggestion(self, candidates: Sequence[FreeKey]) -> Optional[Tuple[str, float]]:
        """The candidate that, free together with the keys, would reduce the residuals most, and by which share; None if
        each removes less than 5 %. A linear model ranks the candidates, and fits decide among the best."""
        now, count, search = self.windows.residuals(self.u), len(self.u), self._with(candidates)
        search.scale_keys()
        slopes, norms = search.windows.derivatives(search.u)
        # The keys get the credit for what they can do themselves.
        base = np.linalg.qr(slopes[:, :count])[0]
        slopes = slopes[:, count:] - base @ (base.T @ slopes[:, count:])
        left = now - base @ (base.T @ now)
        sizes = np.linalg.norm(slopes, axis=0)
        useful = sizes > 1e-3 * norms[count:]  # others do what keys or starts do
        shares = np.where(useful, (left @ slopes / np.maximum(sizes, 1e-300)) ** 2, 0.0) / (left @ left)
        best: Tuple[str, float] = ("", 0.05)
        order = [int(place) for place in np.argsort(-np.round(shares, 3), kind="stable")[:3] if shares[place] > 0.01]
        # The linear model at no friction does not know what sticks.
        order += [i for i, key in enumerate(candidates) if key.name == "ball.losses.rolling" and i not in order]
        for place in order:
            fitted = self._with([candidates[place]])
            fitted.windows.find_kinks(fitted.u)
            fitted.descend(8)
            share = 1 - math.sqrt(fitted.cost() / float(now @ now))
            if share > best[1] + 0.01 * bool(best[0]):
                best = (candidates[place].name, share)
        return best if best[0] else None

    def _with(self, keys: Sequence[FreeKey]) -> "Search":
        """A search from here with more keys."""
        its = self.windows
        wide = WindowsFit(its.logs, its.columns, its.windows, [*self.keys, *keys], its.free, its.threads)
        search = Search(wide, False, silent)
        wide.reweigh(its.noise, its.weights)
        search.u = np.append(self.u, np.zeros(len(keys)))
        wide.linearize(search.u, its.point.starts)
        return search

    def cost(self) -> float:
        """The sum of squares."""
        return float(np.sum(self.windows.residuals(self.u) ** 2))

    @np.errstate(divide="ignore", invalid="ignore")
    def linear(self) -> "Linear":
        """How well the logs determine the keys, by the linear model at u."""
        slopes, norms = self.windows.derivatives(self.u, near=False)
        sizes = np.maximum(norms, 1e-300)
        _, values, directions = np.linalg.svd(slopes / sizes, full_matrices=False)
        known = values > max(_UNTOLD * values[0], 1e-6)
        covariance = (directions[known].T / values[known] ** 2) @ directions[known] / np.outer(sizes, sizes)
        grown = self.windows.base.least / np.sqrt(np.diag(covariance) * self.scatter())
        covariance *= np.outer(np.fmax(grown, 1), np.fmax(grown, 1))
        told = ~(np.abs(directions[~known]) > 0.02).any(0)
        untold = [self._words(direction / sizes, np.abs(direction) > 0.02) for direction in directions[~known]]
        deviations = np.where(told, np.sqrt(np.diag(covariance)), np.nan)
        correlations = covariance / np.outer(deviations, np.where(deviations > 0, deviations, np.nan))
        return Linear(covariance, told, untold, correlations)

    def _words(self, change: Array, members: Array) -> str:
        keys = [(key, by) for key, by, is_in in zip(self.keys, change, members) if is_in]
        names = [key.name for key, _ in keys]
        if len(keys) == 1:
            deaf = self.windows.deaf[:, self.keys.index(keys[0][0])].all()
            why = "no command passes a dead band" if deaf else "other starts of the windows have the same effect"
            return f"{names[0]} is not determined by the log: {why}"
        # The first key's change is 1 %, or a hundredth of its scale.
        changes = []
        for key, by in keys:
            by *= 0.01 / keys[0][1]
            size = f"{_bbsim.rounded(100 * abs(by), 3)} %"
            if not key.logarithmic:
                size = f"{_bbsim.rounded(abs(by) * key.scale, 3)} {key.unit}".rstrip()
            changes.append(f"{key.name} {'-' if by < 0 else '+'}{size}")
        together = f"{', '.join(names[:-1])} and {names[-1]}"
        return f"{together} cannot be told apart: the log stays the same with {', '.join(changes)}"

    def interval(self, k: int, linear: "Linear", profiled: bool) -> List[float]:
        """By profile likelihood, 95 %: how far a key can move, with the others at their best, before the sum of squares
        grows by what that level allows."""
        growth = stdtrit(self.degrees_of_freedom(), 0.975) ** 2 * self.scatter()
        along = linear.covariance[:, k] / math.sqrt(max(linear.covariance[k, k], 1e-300)) * math.sqrt(growth)
        exact = not profiled or self.windows.kinked or growth <= 1e-15 * self.windows.size
        here, ends = (self.windows.base, self.windows.point), []
        for sign in (-1, 1):
            ends.append(self.u[k] + sign * (along[k] if exact else self._distance(k, sign, along, growth)))
            self.windows.restart(*here)  # an end has other starts, or no runs
        ends = [min([ends[0], *self.rivals[:, k]]), max([ends[1], *self.rivals[:, k]])]
        return [float(self.keys[k].value(end)) for end in ends]

    @np.errstate(divide="ignore", invalid="ignore")
    def _distance(self, k: int, sign: float, along: Array, growth: float) -> float:
        """Of an end from u. It solves the problem of the end itself (Venzon and Moolgavkar, Applied Statistics 37,
        1988): each step is exact for residuals that are linear in the keys."""
        windows, (low, high) = self.windows, self.bounds()
        least, inside, outside = self.cost(), 0.0, math.inf
        goal = np.clip(self.u[k] + sign * along[k], low[k], high[k]) - self.u[k]
        to = np.clip(self.u + self._others(k, self.u, windows.residuals(self.u), goal), low, high)
        for count in range(20):
            residuals = windows.residuals(to)
            rest = self._others(k, to, residuals, 0.0)
            size = float(np.sum(residuals**2))
            slack = size - float(np.sum((residuals + windows.derivatives(to)[0] @ rest) ** 2))
            gone = abs(to[k] - self.u[k])
            if gone == 0:
                return 0.0
            ratio = math.sqrt(max(size - slack - least, 1e-6 * growth) / growth)
            at_bound = to[k] in (low[k], high[k]) and ratio <= 1
            if slack < 0.06 * growth and (at_bound or abs(ratio - 1) < (0.03 if count else 0.1)):
                return gone if at_bound else gone / ratio
            if slack > growth:
                to = np.clip(to + rest, low, high)
                continue
            if gone > 30 * along[k]:
                return math.inf
            inside, outside = (max(inside, gone), outside) if ratio < 1 else (inside, min(outside, gone))
            goal = min(max(gone / ratio, 0.3 * gone), 2.5 * gone)
            if outside < math.inf and not 0.1 <= (goal - inside) / (outside - inside) <= 0.9:
                goal = (inside + outside) / 2
            if outside - inside < 0.02 * along[k]:
                return goal
            goal = min(max(self.u[k] + sign * goal, low[k]), high[k]) - to[k]
            to = np.clip(to + self._others(k, to, residuals, goal), low, high)
        return gone

    def _others(self, k: int, u: Array, residuals: Array, by: float) -> Array:
        """The step in which key k moves `by`, and the others go to their best."""
        slopes, _ = self.windows.derivatives(u)
        step, (low, high) = np.zeros(len(u)), self.bounds()
        step[k] = by
        rest = np.flatnonzero((np.arange(len(u)) != k) & (low < high))
        if rest.size:
            # Directions that are hardly determined stay.
            stay = np.diag(_UNTOLD * np.linalg.norm(slopes[:, rest], axis=0))
            small: Any = np.linalg.qr(np.column_stack([slopes[:, rest], residuals + slopes[:, k] * by]), "r")
            matrix, goal = np.concatenate([small[:, :-1], stay]), np.concatenate([small[:, -1], np.zeros(rest.size)])
            room = (np.minimum(low - u, 0)[rest], np.maximum(high - u, 0)[rest])
            step[rest] = lsq_linear(matrix, -goal, room, method="bvls").x
        return step


class Linear(NamedTuple):
    covariance: Array  # over the scatter
    told: Array
    untold: List[str]
    correlations: Array


def _best_step(slopes: Array, residuals: Array, lowest: Array, highest: Array) -> Tuple[Array, float]:
    """To the least sum of squares of the linear model, and how much smaller it is. Keys at a bound may leave it."""
    pushes, step = slopes.T @ residuals, np.zeros(slopes.shape[1])
    free = ~(lowest & (pushes > 0) | highest & (pushes < 0))
    step[free] = -np.linalg.lstsq(slopes[:, free], residuals, 1e-12)[0]
    return step, float(np.sum((slopes @ step) ** 2))
