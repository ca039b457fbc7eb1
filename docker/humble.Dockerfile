# RoboSC with ROS 2 Humble, whose Python 3.10 is too old for it. It generates and builds. `robosc run` does not work
# here.
#   docker build -f docker/humble.Dockerfile -t robosc:humble .
FROM ros:humble-ros-base

ENV UV_PYTHON_INSTALL_DIR=/opt/python
COPY --from=ghcr.io/astral-sh/uv:0.9.0 /uv /usr/local/bin/uv
COPY . /tmp/robosc
RUN uv python install 3.12 \
    && uv venv --python-preference only-managed --python 3.12 /opt/robosc \
    && uv pip install --no-cache --python /opt/robosc/bin/python /tmp/robosc \
    && rm -rf /tmp/robosc
# Links only the tool: python3 stays that of ROS.
RUN ln -s /opt/robosc/bin/robosc /usr/local/bin/robosc
WORKDIR /work
CMD ["bash"]
