"""A square airbag: least energy of one sheet on quadrilateral elements."""
