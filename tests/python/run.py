"""Runs the tests of the package that is installed: run.py [COUNTS FAILED [FILES]]; the first two are files of the stages of
`make test`, FILES which tests to run."""

import os
import sys
import unittest


class Result(unittest.TextTestResult):
    def failed(self):
        return [test for test, _ in self.failures + self.errors] + list(self.unexpectedSuccesses)


def main(counts=None, failed=None, files="test*.py"):
    here = os.path.dirname(os.path.abspath(__file__))
    suite = unittest.defaultTestLoader.discover(here, files)
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
