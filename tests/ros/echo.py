"""Send each message on /question to /answer until interrupted: a lower bound for a message and its answer.

python3 echo.py 1|2
"""

import sys

from topics import connect


def main(version):
    topics = connect(version, "echo")
    answer = topics.publisher("/answer", "std_msgs/Int32")
    topics.listen("/question", "std_msgs/Int32", lambda message: answer(data=message.data))
    while True:
        topics.receive(1.0)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        sys.exit(0)
