"""Calls of a function in processes of this machine or of a cluster, by joblib.

The processes of this machine are those of loky. A cluster runs Dask or Ray. A task and its result are pickled: they
hold texts and numbers, no models.
"""

from __future__ import annotations

import ctypes
import gc
import os
import signal
import sys
import warnings
from collections import deque
from concurrent.futures import BrokenExecutor, Future
from contextlib import closing, contextmanager
from importlib.util import find_spec
from itertools import count
from typing import TYPE_CHECKING, Any, TypeVar

from robosc import __version__
from robosc.tools.cli import CallError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    Deaths = tuple[type[BaseException], ...]

Task = TypeVar("Task")
Result = TypeVar("Result")

#: Option of `prctl`: the signal at the end of the parent, from linux/prctl.h.
_PR_SET_PDEATHSIG = 1
#: Time limit for the first connection to a cluster, and for its first worker.
_PATIENCE_SECONDS = 30


def completed(
    work: Callable[[Task], Result], tasks: Iterable[Task], jobs: int, cluster: str | None = None
) -> Iterator[tuple[Task, Result | None]]:
    """Yield each task with its result, in the order in which they complete.

    `jobs` is the number of processes on this machine; with 1 and without a cluster, the calls run in this process.
    `cluster` is `dask:ADDRESS` or `ray:ADDRESS`; it has its own number of processes. If a process is killed, its tasks
    run again. A task whose process is killed while no other task runs has the result None. An exception of `work` ends
    all calls.

    Raises CallError if a library is missing, or if the cluster cannot be reached or has another version of robosc.
    """
    if jobs == 1 and cluster is None:
        for task in tasks:
            yield task, work(task)
        return
    with _backend(cluster) as deaths:
        numbers = count()
        started: dict[int, Task] = {}
        groups: deque[Iterable[Task]] = deque([iter(tasks)])
        while groups or started:
            # joblib may start a task while it ends because of a killed process.
            group = groups.popleft() if groups else [started.popitem()[1]]
            try:
                for number, result in _results(work, group, numbers, started, jobs if cluster is None else -1):
                    yield started.pop(number), result
            except deaths:
                lost = [started.pop(number) for number in list(started)]
                is_suspect = isinstance(group, list)
                if not is_suspect:
                    groups.appendleft(group)
                if is_suspect and len(lost) == 1:
                    yield lost[0], None
                else:
                    # Halving finds a task that always kills its process; the other tasks complete.
                    half = (len(lost) + 1) // 2
                    groups.extendleft(part for part in (lost[half:], lost[:half]) if part)
            except (ImportError, _OtherVersionError) as error:
                if cluster is None:
                    raise
                hint = f"install robosc {__version__} for all workers"
                raise CallError(f"{cluster}: a worker cannot run the jobs: {error}; {hint}") from error


def processors() -> int:
    """Return the number of processors that this process may use. Raises CallError if joblib is missing."""
    import_needed("joblib", "robosc[sweep]")
    import joblib

    return int(joblib.cpu_count())


def _results(
    work: Callable[[Task], Result], tasks: Iterable[Task], numbers: Iterator[int], started: dict[int, Task], jobs: int
) -> Iterator[tuple[int, Result]]:
    """Yield the number and the result of each task. `started` gets a task by its number before a process does."""
    import joblib

    def calls() -> Iterator[Any]:
        for task in tasks:
            number = next(numbers)
            started[number] = task
            yield joblib.delayed(_call)(work, number, task, __version__)

    # With one process, joblib would use this one. A negative number stands for all processes of a cluster.
    parallel = joblib.Parallel(jobs if jobs < 0 else max(jobs, 2), return_as="generator_unordered", max_nbytes=None)
    with closing(parallel(calls())) as results:
        yield from results


class _OtherVersionError(Exception):
    """A worker has another version of robosc."""


def _call(work: Callable[[Task], Result], number: int, task: Task, version: str) -> tuple[int, Result]:
    if version != __version__:
        raise _OtherVersionError(f"it has robosc {__version__}")
    sys.set_int_max_str_digits(0)  # as in the process of the command
    return number, work(task)


@contextmanager
def _backend(cluster: str | None) -> Iterator[Deaths]:
    """Choose the processes for the `with` block, and yield the exceptions that report a killed process."""
    import_needed("joblib", "robosc[sweep]")
    kind, _, address = (cluster or "loky:").partition(":")
    if kind not in _BACKENDS:
        raise CallError(f"--cluster {cluster}: write dask:tcp://HOST:PORT or ray:ADDRESS")
    with warnings.catch_warnings():
        # joblib warns about tasks without a result after a stop, and about processes that end early.
        warnings.filterwarnings("ignore", module="joblib")
        with _BACKENDS[kind](address) as deaths:
            yield deaths


def import_needed(module: str, package: str) -> None:
    """Raise CallError with the package to install if a module is missing."""
    if find_spec(module) is None:
        raise CallError(f"{module} is missing: run `pip install '{package}'`")


@contextmanager
def _loky(_address: str) -> Iterator[Deaths]:
    import joblib
    from joblib.externals.loky import get_reusable_executor

    try:
        with joblib.parallel_config("loky", initializer=_begin, initargs=(os.getpid(),)):
            yield (BrokenExecutor,)
    finally:
        # Release folders and locks now. joblib does so at the end of the interpreter, which the command skips.
        executor = get_reusable_executor(reuse=True)
        getattr(executor, "terminate", executor.shutdown)(kill_workers=True)
        gc.collect()


def _begin(parent: int) -> None:
    """Prepare a process of this machine: only the command handles interrupts and shows progress.

    On Linux, the process gets SIGTERM when its parent ends, and removes its temporary folders.
    """
    end_with_parent(parent)
    sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115


def end_with_parent(parent: int) -> None:
    """Ignore interrupts, and on Linux end this process by SIGTERM when its parent ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
        if os.getppid() != parent:  # The parent has ended before the call.
            os._exit(1)


@contextmanager
def _dask(address: str) -> Iterator[Deaths]:
    import_needed("distributed", "robosc[cluster]")
    import joblib
    from distributed import Client
    from distributed.scheduler import KilledWorker
    from joblib._dask import DaskDistributedBackend

    class Backend(DaskDistributedBackend):
        """joblib's own backend waits forever for a task that Dask gives up."""

        def submit(self, func: Any, callback: Any = None) -> Any:
            future = super().submit(func, callback)
            future.add_done_callback(lambda done: callback(done) if done.exception() else None)
            return future

        def retrieve_result_callback(self, out: Any) -> Any:
            return super().retrieve_result_callback(out.result() if isinstance(out, Future) else out)

    joblib.register_parallel_backend("robosc-dask", Backend)
    try:
        with (
            Client(address, timeout=_PATIENCE_SECONDS, set_as_default=False) as client,
            joblib.parallel_config("robosc-dask", client=client, wait_for_workers_timeout=_PATIENCE_SECONDS),
        ):
            yield (KilledWorker,)
    except (OSError, ValueError) as error:
        raise CallError(f"--cluster dask:{address}: {error}") from error


@contextmanager
def _ray(address: str) -> Iterator[Deaths]:
    import_needed("ray", "ray")
    import joblib
    import ray
    from ray.util.joblib.ray_backend import RayBackend

    class Backend(RayBackend):
        """Ray's backend has callbacks, so that results can be yielded one by one."""

        supports_return_generator = True

    joblib.register_parallel_backend("robosc-ray", Backend)
    try:
        ray.init(address=address or None, logging_level="ERROR")
    except (ConnectionError, ValueError) as error:
        raise CallError(f"--cluster ray:{address}: {error}") from error
    try:
        with joblib.parallel_config("robosc-ray"):
            yield (ray.exceptions.RayActorError, ray.exceptions.WorkerCrashedError)
    finally:
        ray.shutdown()


_BACKENDS = {"loky": _loky, "dask": _dask, "ray": _ray}
