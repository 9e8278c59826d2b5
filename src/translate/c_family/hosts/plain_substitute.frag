$shader
