"""Before any mesh is opened: is the file a URDF that engines may see?"""
