# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""What users see of the compiled part. The rest is for the package alone."""

from typing import Any, Optional, Tuple

_Pair = Tuple[float, float]

__version__: str

class Sample:
    """What a callable controller receives, in SI units and radians."""

    sample: int
    t: float
    ball: Optional[_Pair]
    reference: _Pair
    reference_rate: _Pair
    reference_acceleration: _Pair
    servo: _Pair
    servo_rate: _Pair
    def __getitem__(self, name: str) -> Any: ...

def __getattr__(name: str) -> Any: ...
