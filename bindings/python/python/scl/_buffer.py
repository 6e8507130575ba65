"""The type of messages that gates without a type send."""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    # Type checkers resolve it even if the package is not installed.
    from typing_extensions import Buffer
elif sys.version_info >= (3, 12):
    from collections.abc import Buffer
else:
    # Python 3.11 has the protocol, but no class for it.
    Buffer = object

__all__ = ["Buffer"]
