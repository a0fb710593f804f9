"""The command line of sincro: ``python -m sincro run SCENE``."""

import signal
import sys


def main():
    """Runs the command line and ends the process with its exit status."""
    from . import _sincro

    # Ctrl-C is the command line's own, as in the program
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.stdout.flush()
    sys.exit(_sincro.command_line(["sincro", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
