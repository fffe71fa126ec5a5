"""Parts made by others: a web service or a program of the user turns an image or a sentence into segmented meshes."""
