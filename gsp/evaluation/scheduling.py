"""Running independent pieces of work: in this thread, in threads, or by a given executor."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import (
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
)
from contextlib import contextmanager
from itertools import islice
from queue import SimpleQueue
from typing import TypeVar

from gsp.checks import check_integer, check_type
from gsp.errors import GspError

Item = TypeVar("Item")
Result = TypeVar("Result")

# How often a piece is submitted again after a failure that is not an error of the library.
RETRIES = 3
# Pieces that are submitted ahead: per thread (enough that threads do not wait while the caller
# stores results), per worker of an executor, and to an executor of an unknown number of workers.
AHEAD_THREAD, AHEAD_WORKER, AHEAD_UNKNOWN = 8, 4, 64


def run_all(
    function: Callable[[Item], Result],
    items: Iterator[Item],
    number: int,
    *,
    workers: int | None = None,
    executor: Executor | None = None,
) -> Iterator[tuple[Item, Result]]:
    """Yield items with their results, each as soon as it is computed; few are in memory at once.

    Parameters
    ----------
    function : item -> result
        For an executor of other processes, both have to be picklable.
    items : iterator of `number` items
    workers : int or None
        Threads without an executor; default all cores.
    executor : concurrent.futures.Executor or None
        It is not shut down. An item that fails for another reason than an error of the library is
        submitted again. If the executor takes none, or fails each time, it is computed in this
        process.
    """
    threads = min(
        number, check_integer("workers", os.cpu_count() or 1 if workers is None else workers)
    )
    if executor is not None:
        check_type("executor", executor, Executor, "a concurrent.futures.Executor")
        ahead = AHEAD_UNKNOWN if workers is None else AHEAD_WORKER * workers
        yield from _completed(function, items, executor, ahead)
    elif threads <= 1:
        yield from ((item, function(item)) for item in items)
    else:
        with pool_of(threads) as pool:
            yield from _completed(function, items, pool, AHEAD_THREAD * threads)


@contextmanager
def pool_of(threads: int) -> Iterator[ThreadPoolExecutor]:
    """Yield a pool of threads; an interrupt or an error does not wait for what they compute.

    The first piece may be compiled for half a minute, and Ctrl-C should not last that long.
    """
    pool = ThreadPoolExecutor(threads)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()


def _completed(
    function: Callable[[Item], Result], items: Iterator[Item], executor: Executor, ahead: int
) -> Iterator[tuple[Item, Result]]:
    pending: dict[Future[Result], tuple[Item, int]] = {}
    done: SimpleQueue[Future[Result]] = SimpleQueue()

    def submit(item: Item, failures: int) -> None:
        future = _submitted(function, item, executor)
        pending[future] = item, failures
        future.add_done_callback(done.put)

    try:
        for item in islice(items, ahead):
            submit(item, 0)
        while pending:
            future = done.get()
            item, failures = pending.pop(future)
            error = _failure(future)
            if error is None:
                yield item, future.result()
                for following in islice(items, 1):
                    submit(following, 0)
            elif isinstance(error, GspError) or not isinstance(error, Exception):
                raise error
            elif failures == RETRIES:
                yield item, _run_here(function, item, error)
            else:
                submit(item, failures + 1)
    finally:
        for future in pending:
            future.cancel()


def _failure(future: Future[Result]) -> BaseException | None:
    try:
        return future.exception()
    except CancelledError as error:
        return error


def _submitted(
    function: Callable[[Item], Result], item: Item, executor: Executor
) -> Future[Result]:
    """Submit an item to the executor; if that takes none, run it in this thread."""
    try:
        return executor.submit(function, item)
    except Exception as error:  # it is broken, shut down, or a user's own
        future: Future[Result] = Future()
        future.set_result(_run_here(function, item, error))
        return future


def _run_here(function: Callable[[Item], Result], item: Item, error: Exception) -> Result:
    message = f"the executor failed ({type(error).__name__}); its items are run in this process"
    warnings.warn(message, RuntimeWarning, stacklevel=2)
    return function(item)
