"""What ``pyproject.toml`` cannot say: packages are found, and two folders of the tree go inside them."""

from setuptools import find_packages, setup

setup(packages=[*find_packages(include=["weakforms*"]), "weakforms._cases", "weakforms._reference_data"])
