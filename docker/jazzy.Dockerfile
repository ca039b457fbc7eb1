# RoboSC on ROS 2 Jazzy: generates, builds and runs. Build it in the root of the repository:
#   docker build -f docker/jazzy.Dockerfile -t robosc:jazzy .
FROM node:24-slim AS page
COPY web /robosc/web
RUN npm ci --prefix /robosc/web && npm run build --prefix /robosc/web

FROM ros:jazzy-ros-base

# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install --yes --no-install-recommends python3-venv \
    && rm -rf /var/lib/apt/lists/*
COPY . /tmp/robosc
# The page of `robosc view`, which a clone does not have.
COPY --from=page /robosc/robosc/tools/view/built /tmp/robosc/robosc/tools/view/built
# Python 3.12 of Ubuntu 24.04. The environment includes ROS's own modules, so that `robosc run` uses this ROS.
RUN python3 -m venv --system-site-packages /opt/robosc \
    && /opt/robosc/bin/pip install --no-cache-dir '/tmp/robosc[view]' \
    && rm -rf /tmp/robosc
ENV PATH=/opt/robosc/bin:$PATH
WORKDIR /work
CMD ["bash"]
