# Four stages:
#   deps   Debian's DOLFINx, PETSc, SLEPc and the ordinary Python packages; nothing of this tree.
#          `./run` works in it with the tree mounted. Its tag is a hash of the text of this stage.
#   lint   deps, a browser that opens and prints the report, and ruff, which Debian does not have;
#          only `./run test`, `./run lint` and `./run report --pdf` need it.
#   notebook  deps and Jupyter; only `./run notebook` needs it.
#   final  deps and this package, with a warm JIT cache: `docker run IMAGE verify`.

# Another release of Debian, such as sid: --build-arg DEBIAN=sid
ARG DEBIAN=trixie
FROM debian:${DEBIAN}-slim AS deps

# OpenBLAS replaces the reference BLAS, with which MUMPS and SLEPc take 50 % longer
# on surfaces. The JIT compiles forms with gcc and g++. git provides a result's provenance.
# tini is the first process, so that Ctrl-C and `docker stop` reach the program.
RUN apt-get -o Acquire::Retries=3 update \
 && DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 install -y --no-install-recommends \
        python3-dolfinx-real python3-petsc4py-real python3-slepc4py-real \
        python3-gmsh python3-meshio \
        python3-numpy python3-scipy python3-matplotlib \
        python3-typer python3-rich python3-pydantic python3-jinja2 python3-jsonschema \
        python3-mdit-py-plugins python3-pandas python3-xarray \
        python3-hypothesis python3-pytest python3-pytest-xdist python3-pytest-timeout \
        python3-pip python3-setuptools python3-wheel \
        libopenblas0-serial openmpi-bin gcc g++ libc6-dev git ca-certificates tini \
 && apt-get clean \
 && rm -rf /var/lib/apt/lists/*

# One folder for all files other than results; any user may write there.
# `weakforms` finds the package through PYTHONPATH here; the final stage installs it properly.
# The mounted tree belongs to the caller; git would otherwise refuse to read it.
RUN install -d -m 1777 /var/cache/weakforms /var/cache/weakforms/home /work \
 && printf '%s\n' '#!/usr/bin/python3' 'import sys' 'from weakforms.cli import main' \
        'if __name__ == "__main__":' '    sys.exit(main())' > /usr/local/bin/weakforms \
 && chmod 755 /usr/local/bin/weakforms \
 && git config --system safe.directory '*'

# `run` reads this list too: one NAME=VALUE per line, no blanks. One thread per rank: the problems are
# small. MPI stays within the machine, may run as root, may start more ranks than there are cores,
# and binds none of them, because several mpirun at once would share the first core.
ENV WEAKFORMS_IN_IMAGE=1 \
    LANG=C.UTF-8 \
    HOME=/var/cache/weakforms/home \
    XDG_CACHE_HOME=/var/cache/weakforms \
    MPLCONFIGDIR=/var/cache/weakforms/matplotlib \
    MPLBACKEND=agg \
    HYPOTHESIS_STORAGE_DIRECTORY=/var/cache/weakforms/hypothesis \
    RUFF_CACHE_DIR=/var/cache/weakforms/ruff \
    OMP_NUM_THREADS=1 \
    OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    OMPI_MCA_btl=self,sm \
    PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe \
    PRTE_MCA_hwloc_default_binding_policy=none

FROM deps AS lint
RUN apt-get -o Acquire::Retries=3 update \
 && DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 install -y --no-install-recommends \
        chromium-headless-shell \
 && apt-get clean \
 && rm -rf /var/lib/apt/lists/*

# A certificate bundle may be passed for networks with their own authority.
RUN --mount=type=secret,id=ca,target=/run/secrets/ca \
    if [ -s /run/secrets/ca ]; then export PIP_CERT=/run/secrets/ca; fi; \
    pip install --break-system-packages --no-cache-dir --root-user-action=ignore ruff==0.17.5

FROM deps AS notebook
RUN apt-get -o Acquire::Retries=3 update \
 && DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 install -y --no-install-recommends \
        jupyter-notebook python3-ipykernel python3-nbconvert \
 && apt-get clean \
 && rm -rf /var/lib/apt/lists/*

FROM deps AS final
ARG VERSION=0.1.0
LABEL org.opencontainers.image.title="weakforms" \
      org.opencontainers.image.description="FEniCSx weak-form verification suite for hyperelastic membranes" \
      org.opencontainers.image.version="${VERSION}" \
      org.opencontainers.image.licenses="MIT" \
      org.opencontainers.image.authors="The weakforms authors"
WORKDIR /weakforms
COPY pyproject.toml setup.py README.md LICENSE CITATION.cff ./
COPY weakforms weakforms
COPY cases cases
COPY reference_data reference_data
# Editable: the package finds its cases and reference tables beside its own folder.
RUN pip install --break-system-packages --no-cache-dir --root-user-action=ignore \
        --no-deps --no-build-isolation --no-index --editable . \
 && weakforms warm \
 && python3 -m compileall -q weakforms cases reference_data \
 && chmod -R a+rwX /var/cache/weakforms
# The contents of the image: every Debian package with its version and the licences its copyright file names.
RUN install -d /usr/share/doc/weakforms && cd /usr/share/doc \
 && dpkg-query -W -f '${db:Status-Abbrev}${Package} ${Version}\n' | sed -n 's/^ii *//p' \
  | while read -r package version; do \
      found=$(sed -n 's/^License: *//p' "$package/copyright" 2>/dev/null | sort -u | paste -s -d ';') \
      && printf '%s %s: %s\n' "$package" "$version" "${found:-see /usr/share/doc/$package/copyright}"; \
    done > weakforms/licenses.txt \
 && printf 'weakforms %s: MIT\n' "$VERSION" >> weakforms/licenses.txt \
 && grep -q '^python3-dolfinx-real ' weakforms/licenses.txt
COPY run Dockerfile ./
COPY tests tests
# Any user may run the tests; only root could write pytest's own cache into the tree.
ENV PYTEST_ADDOPTS="-p no:cacheprovider"
WORKDIR /work
ENTRYPOINT ["tini", "-s", "--", "weakforms"]
CMD ["--help"]
