# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
#
#   docker build -t bbsim .
#   docker run --rm -v "$PWD:/work" bbsim run configs/fig2a.yaml -o fig2a.csv

# What bbsim is built with; .devcontainer/ stops here.
FROM debian:12 AS tools
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates dpkg-dev file git
WORKDIR /bbsim
COPY scripts scripts
RUN scripts/setup

FROM tools AS build
COPY . .
RUN cmake --preset release -DBBSIM_TESTS=OFF && cmake --build --preset release && scripts/package build/release

# Program, Python package, and nothing that builds them.
FROM debian:12-slim
RUN --mount=type=bind,from=build,source=/bbsim/build/release/packages,target=/packages \
    apt-get update \
    && apt-get install -y --no-install-recommends python3-matplotlib python3-scipy /packages/bbsim_*.deb /packages/python3-bbsim_*.deb \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["bbsim"]
CMD ["--help"]
