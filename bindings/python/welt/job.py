"""Long calls: progress, cancelling, Ctrl-C."""

from __future__ import annotations

import ctypes
import threading
from typing import Any, Callable, List, Optional, TypeVar

from ._handle import Handle, call, make

T = TypeVar("T")

#: Seconds from one call of an observer to the next.
INTERVAL = 0.05


class Job(Handle):
    """Watches and cancels one long call, to which it is passed as `job=`.

    progress: is called as `progress(done, stage)` about 20 times a second by the thread that made the call, with the part that
    is done in [0, 1] and the name of the stage; and once at the end. What it raises cancels the call and comes out of it.

    Ctrl-C cancels a long call with or without a job; what the call was changing is then as it was before.
    """

    _free = "welt_job_free"
    _kind = "job"

    def __init__(self, progress: Optional[Callable[[float, str], Any]] = None) -> None:
        self._take_over(make("welt_job_create"))
        self._observer = progress

    def cancel(self) -> None:
        """Asks the call to stop, from any thread; it raises CancelledError soon after."""
        call("welt_job_cancel", self)

    @property
    def progress(self) -> float:
        """How much of the present call is done, in [0, 1]."""
        return float(call("welt_job_progress", self))

    @property
    def stage(self) -> str:
        """The name of the present stage."""
        buffer = ctypes.create_string_buffer(64)
        call("welt_job_stage", self, buffer, len(buffer))
        return buffer.value.decode(errors="ignore")


def run(job: Optional[Job], work: Callable[[Optional[Job]], T]) -> T:
    """Runs a call that takes a job.

    A thread of its own does the work while this one waits: only so can Ctrl-C, which Python brings to the main thread,
    and whatever an observer raises, reach the call.
    """
    if job is None and threading.current_thread() is not threading.main_thread():
        return work(None)
    watched = job or Job()
    results: List[T] = []
    failures: List[BaseException] = []
    done = threading.Event()

    def worker() -> None:
        try:
            results.append(work(watched))
        except BaseException as failure:  # It comes out of the thread that waits.
            failures.append(failure)
        finally:
            done.set()

    thread = threading.Thread(target=worker, name="welt")
    observer = watched._observer
    try:
        thread.start()
        while not done.wait(INTERVAL):
            if observer:
                observer(watched.progress, watched.stage)
    except BaseException:
        watched.cancel()
        while thread.is_alive():
            try:
                thread.join()
            except KeyboardInterrupt:
                pass
        raise
    thread.join()
    if failures:
        raise failures[0]
    if observer:
        observer(1.0, "done")
    return results[0]
