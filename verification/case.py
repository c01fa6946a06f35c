"""`verification.framework.case` under the name that authors of cases know."""

from verification.framework.case import *  # noqa: F403  # the documented name of the module stays importable
