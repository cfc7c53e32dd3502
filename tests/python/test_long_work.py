"""Progress, Ctrl+C, threads and processes."""

import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import knead
from support import sheet, surface


class Told(Exception):
    pass


class Progress(unittest.TestCase):
    def test_every_step_is_told(self):
        told = []
        sheet().step(4, progress=lambda done, all: told.append((done, all)))
        self.assertEqual(told[-1], (4, 4))
        self.assertEqual(len(told), len(set(told)))

    def test_exceptions_arrive_unchanged_and_whole_steps_stay(self):
        doc, raised = sheet(), Told("third")

        def stop(done, all):
            if done == 3:
                raise raised

        with self.assertRaises(Told) as caught:
            doc.step(10, progress=stop)
        self.assertIs(caught.exception, raised)
        self.assertEqual(len(doc.report.steps), 3)
        doc.step(1)
        self.assertEqual(len(doc.report.steps), 4)

    def test_false_stops(self):
        doc = sheet().step(10, progress=lambda done, all: done < 2)
        self.assertEqual(len(doc.report.steps), 2)

    def test_a_callback_must_not_use_its_session(self):
        doc = sheet()
        for use in (doc.step, doc.undo, lambda: doc.script, lambda: doc.surfaces[0].shape, doc.to_bytes):
            with self.assertRaisesRegex(RuntimeError, "callback"):
                doc.step(2, progress=lambda done, all: use())
        other = sheet()
        doc.step(1, progress=lambda done, all: other.step(1) and None)
        self.assertGreaterEqual(len(other.report.steps), 1)

    def test_a_bar(self):
        code = "from support import sheet; sheet().step(3, progress=True)"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                              cwd=os.path.dirname(os.path.abspath(__file__)))
        self.assertIn("3/3", done.stderr)
        with self.assertRaisesRegex(TypeError, "progress must be"):
            sheet().step(1, progress=7)


class Interrupted(unittest.TestCase):
    def setUp(self):
        # What a shell starts in the background inherits that the signal is ignored.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)

    def interrupted(self, work, seconds, after=1):
        """Begins work(progress); Ctrl+C comes some time after the first steps, so that it is at work for certain. How many
        steps were told before it came, and how long work went on after it: by the clock, and of this thread."""
        told, sent, clock = [], [], time.pthread_getcpuclockid(threading.main_thread().ident)

        def send():
            sent.append((len(told), time.monotonic(), time.clock_gettime(clock)))
            os.kill(os.getpid(), signal.SIGINT)

        def progress(*_):
            told.append(None)
            if len(told) == after:
                timer = threading.Timer(seconds, send)
                timer.start()
                self.addCleanup(timer.join)

        with self.assertRaises(KeyboardInterrupt):
            work(progress)
        steps, wall, busy = sent[0]
        return steps, time.monotonic() - wall, time.thread_time() - busy

    def left_within_a_step(self, net, times):
        """How many of so many steps under way were left at Ctrl+C; the others were finished, and no other was begun."""
        doc, longest, busy, left = sheet(net=net).step(1), 0.0, 0.0, 0
        for k in range(times):
            before = len(doc.report.steps)
            told, seconds, work = self.interrupted(
                lambda progress: doc.step(100000, lambda_=50, progress=progress), 0.05 + 0.03 * k)
            longest, busy = max(longest, seconds), max(busy, work)
            steps = len(doc.report.steps)
            self.assertIn(steps - before, (told, told + 1))
            left += steps - before == told
            doc.step(1)
            self.assertEqual(len(doc.report.steps), steps + 1)
        # The times themselves are the machine's.
        print(f"Ctrl+C at {net}, {times} times: up to {longest:.3f} s, {busy:.3f} s of work, {left} within a step", file=sys.stderr)
        return left

    def test_ctrl_c_stops_within_a_step(self):
        self.left_within_a_step((150, 150), 20)
        # Steps that take several times as long as signals are not looked for.
        self.assertGreaterEqual(self.left_within_a_step((300, 300), 4), 1)

    def test_a_script_keeps_what_was_whole(self):
        doc = sheet(net=(40, 40))
        self.interrupted(lambda progress: doc.run(
            [{"do": "step", "count": 1}, {"do": "step", "count": 100000}, {"do": "undo"}], progress=progress), 0.1, after=3)
        self.assertGreater(len(doc.report.steps), 1)


class Threads(unittest.TestCase):
    def test_the_interpreter_goes_on_meanwhile(self):
        doc, count = sheet(net=(60, 60)), [0]
        worker = threading.Thread(target=lambda: doc.step(60))
        worker.start()
        while worker.is_alive():
            count[0] += 1
            time.sleep(0.001)
        self.assertGreater(count[0], 5)

    def test_random_calls_from_four_threads(self):
        doc, failures = sheet(net=(8, 8)), []
        curve = next(iter(doc)).shape

        def work(seed):
            random = np.random.default_rng(seed)
            try:
                for _ in range(2500):
                    which = random.integers(0, 9)
                    try:
                        if which == 0:
                            doc.step(1)
                        elif which == 1:
                            doc.undo()
                        elif which == 2:
                            doc.redo()
                        elif which == 3:
                            doc.move("ball", by=(0, 0, float(random.normal() * 0.01)))
                        elif which == 4:
                            next(iter(doc)).control_points.sum()
                        elif which == 5:
                            curve(float(random.uniform(*curve.domain[0])), float(random.uniform(*curve.domain[1])))
                        elif which == 6:
                            doc.selected
                        elif which == 7:
                            curve.closest(random.normal(size=3))
                        else:
                            repr(doc)
                    except knead.Error:
                        pass  # nothing to undo
            except BaseException as error:  # noqa: B902
                failures.append(error)

        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])
        doc.step(1)

    def test_after_a_fork_the_child_works(self):
        doc, s, lines = sheet(net=(60, 60)).step(2), surface(), np.linspace(0, 4, 500)
        before = s.grid(lines, lines)  # with the threads of the library, which the child does not have
        read, write = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                doc.step(2)
                if (s.grid(lines, lines) == before).all():
                    os.write(write, str(len(doc.report.steps)).encode())
            finally:
                os._exit(0)
        os.close(write)
        self.assertEqual(os.read(read, 10), b"4")
        os.close(read)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertEqual(len(doc.report.steps), 2)


if __name__ == "__main__":
    unittest.main()
