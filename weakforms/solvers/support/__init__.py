"""Support code: releases of DOLFINx, the cache of compiled forms, provenance, values at points."""
