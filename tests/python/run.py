"""Runs the tests of the package that is installed: run.py [COUNTS FAILED], files of the stages of `make test`."""

import os
import sys
import unittest


class Result(unittest.TextTestResult):
    def failed(self):
        return [test for test, _ in self.failures + self.errors] + list(self.unexpectedSuccesses)


def main(counts=None, failed=None):
    here = os.path.dirname(os.path.abspath(__file__))
    suite = unittest.defaultTestLoader.discover(here)
    result = unittest.TextTestRunner(resultclass=Result, verbosity=1).run(suite)
    lost, skipped = result.failed(), len(result.skipped)
    if counts:
        with open(counts, "w", encoding="utf-8") as file:
            file.write(f"{result.testsRun - len(lost) - skipped} {len(lost)} {skipped}\n")
        with open(failed, "w", encoding="utf-8") as file:
            file.writelines(f"scripts/python_test.sh  # {test}\n" for test in lost)
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
